// Rays through an octree, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "structures/octree_traversal.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "structures/octree_scene.h"
#include "structures/plane_ray.h"
#include "trace/exact_tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// Revelles, Urena and Lastra 2000, "An Efficient Parametric Algorithm for Octree Traversal", top down: an
// entry's interval of t holds those of all points that count of the triangles that its cell answers for, by
// induction from the root, as the planes' t are known within bounds (structures/plane_ray.h). The child on
// the near side of all three planes comes first, and child i before j where i's far sides are a part of j's;
// exclusive or with the signs of the direction turns child numbers into sets of far sides.
struct OctreeTraversal {
  struct Entry {
    double entry, exit;
    std::uint32_t node;
  };

  template <class Query>
  static void run(const OctreeScene& scene, const Ray& ray, Query& query) {
    const PlaneRay planes(ray);
    Entry now{0.0, 0.0, 0};
    query.count_volumes(1);
    if (scene.nodes.empty() || !planes.meets(scene.box, query.limit(), now.entry, now.exit)) return;
    unsigned near_child = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
      near_child |= planes.forward(static_cast<int>(axis)) ? 0u : 1u << axis;
    ExactTests<kOctreeLanes> tests(scene.greatest, ray, query.limit());
    Entry stack[7 * kMaxOctreeDepth + 1];
    Entry* top = stack;
    for (;;) {
      const OctreeNode& node = scene.nodes[now.node];
      if (node.count == OctreeNode::kInner) {
        PlaneInterval t[3];
        for (int axis = 0; axis < 3; ++axis) t[axis] = planes.meet(axis, node.middle[axis]);
        // The last first, so that the first is on top.
        for (unsigned far = 8; far-- > 0;) {
          Entry child{now.entry, now.exit, node.first + (far ^ near_child)};
          for (unsigned axis = 0; axis < 3; ++axis) {
            if ((far >> axis & 1u) != 0) {
              if (t[axis].lo > child.entry) child.entry = t[axis].lo;
            } else {
              if (t[axis].hi < child.exit) child.exit = t[axis].hi;
            }
          }
          if (child.entry <= child.exit && scene.nodes[child.node].count != 0) *top++ = child;
        }
      } else if (node.count != 0) {
        query.count_triangles(node.count);
        if (tests.leaf(&scene.blocks[node.first], node.count, query)) return;
      }
      do {
        if (top == stack) return;
        now = *--top;
      } while (now.entry > double{query.limit()});
      query.count_volumes(1);
    }
  }
};

QueryTable OctreeQueries() { return make_query_table<OctreeScene, OctreeTraversal>(); }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(OctreeQueries);

QueryTable octree_queries(Simd simd) { return PLUMB_DISPATCH(OctreeQueries, simd)(); }

}  // namespace plumb::detail
#endif
