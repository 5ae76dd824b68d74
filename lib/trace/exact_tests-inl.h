// The exact arithmetic: boxes are culled conservatively, a leaf's triangles are tested W at once in float
// with a proven bound, and lanes that the float stage leaves open are decided one at a time in double
// or by expansions. So are depths, but only where their float bounds do not say enough: of covered triangles
// with bounds apart only the nearest's is ever computed (trace/query.h). Included once per Highway target.

#if defined(PLUMB_TRACE_EXACT_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_EXACT_TESTS_INL_H_
#undef PLUMB_TRACE_EXACT_TESTS_INL_H_
#else
#define PLUMB_TRACE_EXACT_TESTS_INL_H_
#endif

#include <cstdint>
#include <limits>
#include <optional>

#include "base/mask_bits-inl.h"
#include "exact/filter-inl.h"
#include "exact/filter_ray.h"
#include "exact/intersect.h"
#include "hwy/highway.h"
#include "trace/box_ray.h"
#include "trace/box_test-inl.h"
#include "trace/traverse-inl.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int W>
class ExactTests {
 public:
  // `greatest` is the greatest |coordinate| of the scene's finite triangles.
  ExactTests(float greatest, const Ray& ray, float limit)
      : ray_(ray), box_ray_(ray, greatest), filter_(ray, greatest) {
    if (HWY_UNLIKELY(!box_ray_.in_range)) {
      staying_ray_.emplace(ray, greatest);
      exact_ray_.emplace(ray);
    }
    filter_.set_limit(limit);
  }

  // No exact t above `limit` matters.
  void set_limit(float limit) { filter_.set_limit(limit); }

  HWY_INLINE std::uint32_t boxes(const WideNode<W>& node, float limit, float* near) const {
    return HWY_LIKELY(box_ray_.in_range) ? TestBoxes<W>(node, box_ray_, limit, near)
                                         : other_boxes(node, limit, near);
  }

  template <class Query>
  HWY_INLINE bool leaf(const TriangleBlock<W>* block, std::uint32_t count, Query& query) {
    const hn::CappedTag<float, W> d;
    using V = hn::Vec<decltype(d)>;
    for (;; ++block) {
      std::uint32_t possible_bits = 0;
      std::uint32_t certain_bits = 0;
      HWY_ALIGN float low[W];
      HWY_ALIGN float high[W];
      for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
        hn::Mask<decltype(d)> possible;
        hn::Mask<decltype(d)> certain;
        V along, along_error, size, size_error;
        FilterTriangles(d, filter_, *block, lane, possible, certain, along, along_error, size, size_error);
        const std::uint32_t bits = MaskBits(d, possible);
        if (bits == 0) continue;
        possible_bits |= bits << lane;
        certain_bits |= MaskBits(d, certain) << lane;
        if constexpr (Query::kBoundsDepth) {
          V least, greatest;
          DepthBounds(d, along, along_error, size, size_error, least, greatest);
          hn::Store(least, d, low + lane);
          hn::Store(greatest, d, high + lane);
        }
      }
      if (count < static_cast<std::uint32_t>(W)) possible_bits &= (1u << count) - 1u;
      for (; possible_bits != 0; possible_bits &= possible_bits - 1) {
        const auto lane = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(possible_bits));
        const bool covered = (certain_bits >> lane & 1u) != 0;
        if constexpr (Query::kBoundsDepth) {
          const LaneTriangle triangle{&block->vertex[0][0][lane], W, block->id[lane]};
          if (covered && query.take_bounds(low[lane], high[lane], triangle)) {
            if (query.done()) return true;
            continue;
          }
        }
        if (offer(*block, lane, covered, query)) return true;
      }
      if (count <= static_cast<std::uint32_t>(W)) break;
      count -= static_cast<std::uint32_t>(W);
    }
    if constexpr (Query::kOrdered) filter_.set_limit(query.limit());
    return false;
  }

 private:
  HWY_NOINLINE std::uint32_t other_boxes(const WideNode<W>& node, float limit, float* near) const {
    return staying_ray_->in_range ? TestBoxes<W>(node, *staying_ray_, StayingBoxRay::finite(limit), near)
                                  : meet_children<W>(node, *exact_ray_, limit, near);
  }

  // Decides about one lane; true when the query is done.
  template <class Query>
  HWY_INLINE bool offer(const TriangleBlock<W>& block, size_t lane, bool covered, Query& query) const {
    const Triangle triangle = TriangleOf(block, lane);
    if constexpr (Query::kAnyHit) {
      return query.take_any(ray_meets(ray_, triangle, covered));
    }
    float t = 0.0f;
    if (!ray_hit(ray_, triangle, covered, query.limit(), t)) return false;
    return query.take(t, block.id[lane]);
  }

  const Ray& ray_;
  BoxRay box_ray_;
  std::optional<StayingBoxRay> staying_ray_;
  std::optional<ExactBoxRay> exact_ray_;
  FilterRay filter_;
};

template <class Tree>
struct ExactTraversal {
  template <class Query>
  static void run(const Tree& tree, const Ray& ray, Query& query) {
    ExactTests<Tree::kWidth> tests(tree.greatest, ray, query.limit());
    Traverse(tree, tests, query);
  }
};

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
