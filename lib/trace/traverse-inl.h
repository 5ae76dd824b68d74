// One ray through a wide tree: the loop, for every width, query and Highway target.
//
// A node's W boxes are tested at once (Wald, Benthin and Boulos 2008, "Getting Rid of Packets"), the
// children met are taken near to far, and a leaf's triangles are tested W at once in float with a
// proven bound; lanes that the float stage leaves open are decided one at a time in double or exactly.
// Vectors hold min(W, lanes of the target), so W = 8 takes one step on AVX2 and two on SSE4 or NEON.

#if defined(PLUMB_TRACE_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_TRAVERSE_INL_H_
#undef PLUMB_TRACE_TRAVERSE_INL_H_
#else
#define PLUMB_TRACE_TRAVERSE_INL_H_
#endif

#include <cstdint>
#include <optional>

#include "base/mask_bits-inl.h"
#include "build/binary_tree.h"
#include "exact/filter-inl.h"
#include "exact/filter_ray.h"
#include "exact/intersect.h"
#include "hwy/highway.h"
#include "trace/box_ray.h"
#include "trace/query.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The children that the ray may meet no farther than `limit`, one bit each, and their near values.
template <int W>
HWY_INLINE std::uint32_t TestBoxes(const WideNode<W>& node, const BoxRay& ray, float limit, float* near) {
  const hn::CappedTag<float, W> d;
  using V = hn::Vec<decltype(d)>;
  std::uint32_t met = 0;
  for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
    V nearest = hn::Set(d, ray.tmin);
    V farthest = hn::Set(d, limit);
    for (int axis = 0; axis < 3; ++axis) {
      const V origin = hn::Set(d, ray.origin[axis]);
      const V near_plane = hn::Load(d, node.bounds[ray.near_row[axis]] + lane);
      const V far_plane = hn::Load(d, node.bounds[ray.far_row[axis]] + lane);
      nearest = hn::Max(nearest, hn::Mul(hn::Sub(near_plane, origin), hn::Set(d, ray.inv_near[axis])));
      farthest = hn::Min(farthest, hn::Mul(hn::Sub(far_plane, origin), hn::Set(d, ray.inv_far[axis])));
    }
    hn::Store(nearest, d, near + lane);
    const auto meets = hn::Le(hn::Sub(nearest, hn::Set(d, BoxRay::kUnderflow)), farthest);
    met |= MaskBits(d, meets) << lane;
  }
  return met;
}

// Offers the hits of a leaf's `count` triangles to the query. True when the query is done.
template <int W, class Query>
HWY_INLINE bool TestLeaf(const TriangleBlock<W>* block, std::uint32_t count, const Ray& ray,
                         FilterRay& filter, Query& query) {
  const hn::CappedTag<float, W> d;
  for (;; ++block) {
    std::uint32_t possible_bits = 0;
    std::uint32_t certain_bits = 0;
    for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
      hn::Mask<decltype(d)> possible;
      hn::Mask<decltype(d)> certain;
      FilterTriangles(d, filter, *block, lane, possible, certain);
      possible_bits |= MaskBits(d, possible) << lane;
      certain_bits |= MaskBits(d, certain) << lane;
    }
    if (count < static_cast<std::uint32_t>(W)) possible_bits &= (1u << count) - 1u;
    for (; possible_bits != 0; possible_bits &= possible_bits - 1) {
      const auto lane = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(possible_bits));
      const auto corner = [&](int v) {
        return glm::vec3(block->vertex[v][0][lane], block->vertex[v][1][lane], block->vertex[v][2][lane]);
      };
      const Triangle triangle{corner(0), corner(1), corner(2)};
      float t = 0.0f;
      if ((certain_bits >> lane & 1u) != 0) {
        // May be infinite, which counts on no ray: a finite t wins everywhere else, and tmax = inf is
        // excluded by the definition.
        t = line_depth(ray.origin, ray.direction, triangle);
        if (!(t < std::numeric_limits<float>::infinity())) continue;
      } else if (!line_hit(ray.origin, ray.direction, triangle, t)) {
        continue;
      }
      if (query.take(t, block->id[lane])) return true;
    }
    if (count <= static_cast<std::uint32_t>(W)) break;
    count -= static_cast<std::uint32_t>(W);
  }
  filter.set_limit(query.limit());
  return false;
}

struct WideTraversalEntry {
  float near;  // no point of it is nearer
  std::uint32_t child;
  std::uint32_t count;  // triangles of a leaf; 0 for a node
};

template <int W>
struct WideTraversal {
  template <class Query>
  static void run(const WideTree<W>& tree, const Ray& ray, Query& query) {
    const BoxRay box_ray(ray, tree.greatest);
    std::optional<ExactBoxRay> exact_ray;
    if (!box_ray.in_range) exact_ray.emplace(ray);
    FilterRay filter(ray, tree.greatest);
    filter.set_limit(query.limit());

    // Every node visited leaves at most W - 1 siblings on the stack.
    WideTraversalEntry stack[(W - 1) * kMaxTreeDepth + 1];
    WideTraversalEntry* top = stack;
    WideTraversalEntry current{0.0f, 0, 0};
    for (;;) {
      if (current.count != 0) {
        if (TestLeaf<W>(&tree.blocks[current.child], current.count, ray, filter, query)) return;
      } else {
        const WideNode<W>& node = tree.nodes[current.child];
        HWY_ALIGN float near[W];
        std::uint32_t met = HWY_LIKELY(box_ray.in_range)
                                ? TestBoxes<W>(node, box_ray, query.limit(), near)
                                : meet_children<W>(node, *exact_ray, query.limit(), near);
        // Insert by distance, the nearest on top.
        WideTraversalEntry* const base = top;
        for (; met != 0; met &= met - 1) {
          const auto i = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(met));
          const WideTraversalEntry entry{near[i], node.child[i], node.count[i]};
          WideTraversalEntry* place = top++;
          for (; place != base && place[-1].near < entry.near; --place) *place = place[-1];
          *place = entry;
        }
      }
      do {
        if (top == stack) return;
        current = *--top;
      } while (current.near > query.limit());
    }
  }
};

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
