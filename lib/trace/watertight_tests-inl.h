// The watertight arithmetic of Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", W
// triangles at once. Included once per Highway target.
//
// What differs from the paper: the slack of the boxes is derived anew (watertight_ray.h), t is scaled after
// the division, and rays outside the range of that analysis take the exact arithmetic, which has no
// cracks either. No multiplication is fused with an addition: triangles on both sides of an edge must
// compute the same products.

#if defined(PLUMB_TRACE_WATERTIGHT_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_WATERTIGHT_TESTS_INL_H_
#undef PLUMB_TRACE_WATERTIGHT_TESTS_INL_H_
#else
#define PLUMB_TRACE_WATERTIGHT_TESTS_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
#include "trace/box_test-inl.h"
#include "trace/exact_tests-inl.h"
#include "trace/traverse-inl.h"
#include "trace/watertight_ray.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Of a block's lanes [offset, offset + Lanes(d)): `met` are met by the ray's line at a t up to `limit`,
// `open` want watertight_hit.
template <class D, int W>
HWY_INLINE void MeetTriangles(D d, const WatertightRay& ray, const TriangleBlock<W>& block, size_t offset,
                              float limit, hn::Vec<D>& t, hn::Mask<D>& met, hn::Mask<D>& open) {
  using V = hn::Vec<D>;
  const auto moved = [&](int v, int i) HWY_ATTR {
    return hn::Sub(hn::Load(d, block.vertex[v][ray.k[i]] + offset), hn::Set(d, ray.origin[i]));
  };
  const auto sheared = [&](int v, int i, V z)
                           HWY_ATTR { return hn::Sub(moved(v, i), hn::Mul(hn::Set(d, ray.shear[i]), z)); };
  const auto minor = [](V a, V b, V p, V q) HWY_ATTR { return hn::Sub(hn::Mul(a, b), hn::Mul(p, q)); };
  const V az = moved(0, 2), bz = moved(1, 2), cz = moved(2, 2);
  const V ax = sheared(0, 0, az), bx = sheared(1, 0, bz), cx = sheared(2, 0, cz);
  const V ay = sheared(0, 1, az), by = sheared(1, 1, bz), cy = sheared(2, 1, cz);
  const V u = minor(cx, by, cy, bx), v = minor(ax, cy, ay, cx), w = minor(bx, ay, by, ax);

  const V zero = hn::Zero(d);
  const V least = hn::Min(u, hn::Min(v, w)), most = hn::Max(u, hn::Max(v, w));
  const V sum = hn::Add(hn::Add(u, v), w);
  const auto mixed = hn::And(hn::Lt(least, zero), hn::Gt(most, zero));
  const auto inside = hn::And(hn::Or(hn::Gt(least, zero), hn::Lt(most, zero)),
                              hn::Ge(hn::Abs(sum), hn::Set(d, kLeastWatertightSum)));
  open = hn::Not(hn::Or(mixed, inside));
  const V z = hn::Div(hn::Add(hn::Add(hn::Mul(u, az), hn::Mul(v, bz)), hn::Mul(w, cz)), sum);
  t = hn::Mul(z, hn::Set(d, ray.inverse_z));
  met = hn::And(inside, hn::Le(hn::Abs(t), hn::Set(d, limit)));
}

template <int W>
class WatertightTests {
 public:
  WatertightTests(const WideTree<W>& tree, const Ray& ray) : ray_(ray, tree.box, tree.greatest) {}

  bool in_range() const { return ray_.in_range; }

  HWY_INLINE std::uint32_t boxes(const WideNode<W>& node, float limit, float* near) const {
    return TestBoxes<W>(node, ray_, limit, near);
  }

  template <class Query>
  HWY_INLINE bool leaf(const TriangleBlock<W>* block, std::uint32_t count, Query& query) const {
    const hn::CappedTag<float, W> d;
    for (;; ++block) {
      const float limit = std::min(query.limit(), std::numeric_limits<float>::max());
      HWY_ALIGN float t[W];
      std::uint32_t met_bits = 0;
      std::uint32_t open_bits = 0;
      for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
        hn::Vec<decltype(d)> depth;
        hn::Mask<decltype(d)> met, open;
        MeetTriangles(d, ray_, *block, lane, limit, depth, met, open);
        met_bits |= MaskBits(d, met) << lane;
        open_bits |= MaskBits(d, open) << lane;
        hn::Store(depth, d, t + lane);
      }
      std::uint32_t bits = met_bits | open_bits;
      if (count < static_cast<std::uint32_t>(W)) bits &= (1u << count) - 1u;
      for (; bits != 0; bits &= bits - 1) {
        const auto lane = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
        if ((open_bits >> lane & 1u) != 0 && !watertight_hit(ray_, TriangleOf(*block, lane), t[lane]))
          continue;
        if (query.take(t[lane], block->id[lane])) return true;
      }
      if (count <= static_cast<std::uint32_t>(W)) return false;
      count -= static_cast<std::uint32_t>(W);
    }
  }

 private:
  WatertightRay ray_;
};

template <int W>
struct WatertightTraversal {
  template <class Query>
  static void run(const WideTree<W>& tree, const Ray& ray, Query& query) {
    const WatertightTests<W> tests(tree, ray);
    if (HWY_LIKELY(tests.in_range())) {
      Traverse(tree, tests, query);
    } else {
      ExactTraversal<WideTree<W>>::run(tree, ray, query);
    }
  }
};

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
