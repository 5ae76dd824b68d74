// The fast arithmetic: what most ray tracers do, beside which the cost of the exact one can be seen.
// Included once per Highway target.
//
// Triangles by Moeller and Trumbore 1997, "Fast, Minimum Storage Ray-Triangle Intersection", W at once and
// for both sides. No multiplication is fused with an addition, so that every target rounds alike and
// the answers, right or wrong, are the same.

#if defined(PLUMB_TRACE_FAST_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_FAST_TESTS_INL_H_
#undef PLUMB_TRACE_FAST_TESTS_INL_H_
#else
#define PLUMB_TRACE_FAST_TESTS_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
#include "trace/box_test-inl.h"
#include "trace/fast_ray.h"
#include "trace/traverse-inl.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The lanes [offset, offset + Lanes(d)) of a block whose triangles the ray's line meets at a t up to
// `limit`, and their t. A NaN anywhere is a miss.
template <class D, int W>
HWY_INLINE hn::Mask<D> MeetTriangles(D d, const FastRay& ray, const TriangleBlock<W>& block, size_t offset,
                                     float limit, hn::Vec<D>& t) {
  using V = hn::Vec<D>;
  const auto load = [&](int v, int axis) HWY_ATTR { return hn::Load(d, block.vertex[v][axis] + offset); };
  const auto minor = [](V a, V b, V p, V q) HWY_ATTR { return hn::Sub(hn::Mul(a, b), hn::Mul(p, q)); };
  const auto dot = [](V ax, V ay, V az, V bx, V by, V bz) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(ax, bx), hn::Mul(ay, by)), hn::Mul(az, bz));
  };
  const V dx = hn::Set(d, ray.direction[0]), dy = hn::Set(d, ray.direction[1]),
          dz = hn::Set(d, ray.direction[2]);
  const V v0x = load(0, 0), v0y = load(0, 1), v0z = load(0, 2);
  const V e1x = hn::Sub(load(1, 0), v0x), e1y = hn::Sub(load(1, 1), v0y), e1z = hn::Sub(load(1, 2), v0z);
  const V e2x = hn::Sub(load(2, 0), v0x), e2y = hn::Sub(load(2, 1), v0y), e2z = hn::Sub(load(2, 2), v0z);
  const V px = minor(dy, e2z, dz, e2y), py = minor(dz, e2x, dx, e2z), pz = minor(dx, e2y, dy, e2x);
  const V sx = hn::Sub(hn::Set(d, ray.origin[0]), v0x);
  const V sy = hn::Sub(hn::Set(d, ray.origin[1]), v0y);
  const V sz = hn::Sub(hn::Set(d, ray.origin[2]), v0z);
  const V qx = minor(sy, e1z, sz, e1y), qy = minor(sz, e1x, sx, e1z), qz = minor(sx, e1y, sy, e1x);

  // With the determinant's sign taken out, u, v and u + v are inside when between 0 and the determinant.
  const V det = dot(e1x, e1y, e1z, px, py, pz);
  const V sign = hn::And(hn::SignBit(d), det);
  const V size = hn::Abs(det);
  const V u = hn::Xor(dot(sx, sy, sz, px, py, pz), sign);
  const V v = hn::Xor(dot(dx, dy, dz, qx, qy, qz), sign);
  const V zero = hn::Zero(d);
  const auto inside = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Le(hn::Add(u, v), size));
  t = hn::Div(dot(e2x, e2y, e2z, qx, qy, qz), det);
  return hn::And(inside, hn::Le(hn::Abs(t), hn::Set(d, limit)));
}

template <int W>
class FastTests {
 public:
  explicit FastTests(const Ray& ray) : ray_(ray) {}

  HWY_INLINE std::uint32_t boxes(const WideNode<W>& node, float limit, float* near) const {
    return TestBoxes<W>(node, ray_, limit, near);
  }

  template <class Query>
  HWY_INLINE bool leaf(const TriangleBlock<W>* block, std::uint32_t count, Query& query) const {
    const hn::CappedTag<float, W> d;
    for (;; ++block) {
      const float limit = std::min(query.limit(), std::numeric_limits<float>::max());
      HWY_ALIGN float t[W];
      std::uint32_t met = 0;
      for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
        hn::Vec<decltype(d)> depth;
        met |= MaskBits(d, MeetTriangles(d, ray_, *block, lane, limit, depth)) << lane;
        hn::Store(depth, d, t + lane);
      }
      if (count < static_cast<std::uint32_t>(W)) met &= (1u << count) - 1u;
      for (; met != 0; met &= met - 1) {
        const auto lane = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(met));
        if (query.take(t[lane], block->id[lane])) return true;
      }
      if (count <= static_cast<std::uint32_t>(W)) return false;
      count -= static_cast<std::uint32_t>(W);
    }
  }

 private:
  FastRay ray_;
};

template <int W>
struct FastTraversal {
  template <class Query>
  static void run(const WideTree<W>& tree, const Ray& ray, Query& query) {
    const FastTests<W> tests(ray);
    Traverse(tree, tests, query);
  }
};

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
