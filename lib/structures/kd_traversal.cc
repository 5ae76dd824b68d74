// Rays through a k-d tree, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "structures/kd_traversal.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "structures/kd_scene.h"
#include "structures/plane_ray.h"
#include "trace/exact_tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// Havran 2000, "Heuristic Ray Shooting Algorithms", the recursive traversal with a stack of intervals, here
// with bounds for its distances (structures/plane_ray.h): an entry's interval holds the exact t of every
// point that counts of the triangles that its cell answers for (structures/kd_build.h), by induction from the
// root.
//
// A triangle may be tested in several cells; its hits are the same in each, and the queries take them twice.
// Mailboxes (Amanatides and Woo 1987, "A Fast Voxel Traversal Algorithm for Ray Tracing") are left out on
// purpose: of a ray's tests 6 to 14 % repeat one, but of its blocks of eight only 0.2 to 2 % hold no new
// triangle (9 % for camera rays in Sponza) and could be spared.
struct KdTraversal {
  struct Entry {
    double entry, exit;
    std::uint32_t node;
  };

  template <class Query>
  static void run(const KdScene& scene, const Ray& ray, Query& query) {
    const PlaneRay planes(ray);
    Entry now{0.0, 0.0, 0};
    query.count_volumes(1);
    if (scene.nodes.empty() || !planes.meets(scene.box, query.limit(), now.entry, now.exit)) return;
    ExactTests<kKdLanes> tests(scene.greatest, ray, query.limit());
    Entry stack[kMaxKdDepth];
    Entry* top = stack;
    const KdNode* const nodes = scene.nodes.data();
    for (;;) {
      KdNode node = nodes[now.node];
      while (!node.is_leaf()) {
        const int axis = node.axis();
        const PlaneInterval t = planes.meet(axis, node.plane());
        const bool forward = planes.forward(axis);
        const std::uint32_t near = forward ? now.node + 1 : node.upper();
        const std::uint32_t far = forward ? node.upper() : now.node + 1;
        if (t.hi < now.entry) {
          now.node = far;
        } else {
          if (!(t.lo > now.exit)) {
            *top++ = {t.lo > now.entry ? t.lo : now.entry, now.exit, far};
            if (t.hi < now.exit) now.exit = t.hi;
          }
          now.node = near;
        }
        query.count_volumes(1);
        node = nodes[now.node];
      }
      if (node.count() != 0) {
        query.count_triangles(node.count());
        if (tests.leaf(&scene.blocks[node.first()], node.count(), query)) return;
      }
      do {
        if (top == stack) return;
        now = *--top;
      } while (now.entry > double{query.limit()});
      query.count_volumes(1);
    }
  }
};

QueryTable KdQueries() { return make_query_table<KdScene, KdTraversal>(); }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(KdQueries);

QueryTable kd_queries(Simd simd) { return PLUMB_DISPATCH(KdQueries, simd)(); }

}  // namespace plumb::detail
#endif
