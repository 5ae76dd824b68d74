// The float stage: one ray against a vector of triangles, with a proven bound. Included once per
// Highway target.

#if defined(PLUMB_EXACT_FILTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_EXACT_FILTER_INL_H_
#undef PLUMB_EXACT_FILTER_INL_H_
#else
#define PLUMB_EXACT_FILTER_INL_H_
#endif

#include "exact/filter_ray.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The edge functions, their sum, det(a, b, c) and R = |v0 - o|_max of a block's lanes [offset, offset +
// Lanes(d)).
//
// The values are those of exact/intersect.cc's double stage, and so are the bounds with u = 2^-24:
//     |error of E0, E1, E2| <= 9.01 u D L (2 R + L),  of den <= 7.01 u D L^2,  of T <= 8.01 u R L^2
// They hold whether or not the compiler or Highway fuses a multiplication and an addition, for a fused
// operation rounds once instead of twice. Two things are new in float:
// - Underflow. A product that underflows is off by at most 2^-150. D and L are at least 2^-30 in
//   the bounds (filter_ray.h, wide/wide_tree.h). Of the edge functions, m is off by at most 2^-148
//   more, E by 2^-146 L + 2^-147; the bound's slack between 9.01 and 9.3 is at least
//   0.29 * 2^-24 * 2^-30 * L * max(L, 2^-30) > 2^-86 L and > 2^-116. The same holds for den. T's
//   bound has the constant 2^-120 added, for R may be 0: N is off by 2^-148 more, T by 2^-146 R +
//   2^-147, and 0.09 * 2^-24 R L^2 > 2^-88 R.
// - Overflow. FilterRay's scales are infinite for a ray whose products with this scene could
//   exceed 2^120. Then every lane is `possible`, none `certain`, none too far.
template <class D, int W, template <int> class Block>
HWY_INLINE void FilterValues(D d, const FilterRay& ray, const Block<W>& block, size_t offset,
                             hn::Vec<D>& edge0, hn::Vec<D>& edge1, hn::Vec<D>& edge2, hn::Vec<D>& den,
                             hn::Vec<D>& t_num, hn::Vec<D>& reach) {
  using V = hn::Vec<D>;
  const auto load = [&](int v, int axis) HWY_ATTR { return hn::Load(d, block.vertex[v][axis] + offset); };
  const V v0x = load(0, 0), v0y = load(0, 1), v0z = load(0, 2);
  const V dx = hn::Set(d, ray.direction[0]), dy = hn::Set(d, ray.direction[1]),
          dz = hn::Set(d, ray.direction[2]);
  const V ax = hn::Sub(v0x, hn::Set(d, ray.origin[0]));
  const V ay = hn::Sub(v0y, hn::Set(d, ray.origin[1]));
  const V az = hn::Sub(v0z, hn::Set(d, ray.origin[2]));
  const V e1x = hn::Sub(load(1, 0), v0x), e1y = hn::Sub(load(1, 1), v0y), e1z = hn::Sub(load(1, 2), v0z);
  const V e2x = hn::Sub(load(2, 0), v0x), e2y = hn::Sub(load(2, 1), v0y), e2z = hn::Sub(load(2, 2), v0z);

  // m = d x a, N = e1 x e2
  const V mx = hn::MulSub(dy, az, hn::Mul(dz, ay));
  const V my = hn::MulSub(dz, ax, hn::Mul(dx, az));
  const V mz = hn::MulSub(dx, ay, hn::Mul(dy, ax));
  const V nx = hn::MulSub(e1y, e2z, hn::Mul(e1z, e2y));
  const V ny = hn::MulSub(e1z, e2x, hn::Mul(e1x, e2z));
  const V nz = hn::MulSub(e1x, e2y, hn::Mul(e1y, e2x));

  edge0 = hn::MulAdd(e1z, mz, hn::MulAdd(e1y, my, hn::Mul(e1x, mx)));
  const V edge2_negated = hn::MulAdd(e2z, mz, hn::MulAdd(e2y, my, hn::Mul(e2x, mx)));
  den = hn::MulAdd(nz, dz, hn::MulAdd(ny, dy, hn::Mul(nx, dx)));
  edge1 = hn::Add(hn::Sub(den, edge0), edge2_negated);
  edge2 = hn::Neg(edge2_negated);
  t_num = hn::MulAdd(nz, az, hn::MulAdd(ny, ay, hn::Mul(nx, ax)));
  reach = hn::Max(hn::Abs(ax), hn::Max(hn::Abs(ay), hn::Abs(az)));
}

// Tests the triangles of a block's lanes [offset, offset + Lanes(d)) against the ray.
//
// `possible` lanes may be hits nearer than FilterRay::limit and need a decision; of these, `certain`
// lanes are covered, with a denominator that is not zero: only their depth is open. All others are
// certainly misses or certainly farther than the limit. `along` is T, negated where den is negative, and
// `size` |den|; each is off by at most its error.
template <class D, int W, template <int> class Block>
HWY_INLINE void FilterTriangles(D d, const FilterRay& ray, const Block<W>& block, size_t offset,
                                hn::Mask<D>& possible, hn::Mask<D>& certain, hn::Vec<D>& along,
                                hn::Vec<D>& along_error, hn::Vec<D>& size, hn::Vec<D>& size_error) {
  using V = hn::Vec<D>;
  V edge0, edge1, edge2, den, t_num, reach;
  FilterValues(d, ray, block, offset, edge0, edge1, edge2, den, t_num, reach);
  const V e_min = hn::Min(edge0, hn::Min(edge1, edge2));
  const V e_max = hn::Max(edge0, hn::Max(edge1, edge2));

  const V extent = hn::Load(d, block.extent + offset);
  const V scaled = hn::Mul(extent, hn::Set(d, ray.edge_scale));
  const V error = hn::Mul(scaled, hn::Add(hn::Add(reach, reach), extent));
  const V minus_error = hn::Neg(error);
  const auto missed = hn::And(hn::Lt(e_min, minus_error), hn::Gt(e_max, error));
  certain = hn::Or(hn::Gt(e_min, error), hn::Lt(e_max, minus_error));

  // Too far: T / den > limit for certain, or T / den < 0 for certain. In the first, |T| > limit |den| by
  // more than the errors; the limit carries slack for the rounding of this comparison itself.
  const V extent2 = hn::Mul(extent, extent);
  along_error = hn::MulAdd(hn::Mul(reach, hn::Set(d, ray.depth_scale)), extent2, hn::Set(d, 0x1p-120f));
  size_error = hn::Mul(extent2, hn::Set(d, ray.den_scale));
  size = hn::Abs(den);
  along = hn::Xor(t_num, hn::And(hn::SignBit(d), den));
  const auto beyond =
      hn::Gt(hn::Sub(along, along_error), hn::Mul(hn::Set(d, ray.limit), hn::Add(size, size_error)));
  const auto behind = hn::And(hn::Lt(along, hn::Neg(along_error)), hn::Gt(size, size_error));
  possible = hn::Not(hn::Or(missed, hn::Or(beyond, behind)));
}

// The same for who does not ask about depths.
template <class D, int W, template <int> class Block>
HWY_INLINE void FilterTriangles(D d, const FilterRay& ray, const Block<W>& block, size_t offset,
                                hn::Mask<D>& possible, hn::Mask<D>& certain) {
  hn::Vec<D> along, along_error, size, size_error;
  FilterTriangles(d, ray, block, offset, possible, certain, along, along_error, size, size_error);
}

// Bounds of the exact t = T / den of FilterTriangles' lanes; lanes where they say nothing get low = -1.
//
// T lies within along_error of `along`, |den| within size_error of `size`, so t lies between the quotients of
// their ends. Each of those is rounded three times, off by less than 4 * 2^-24 of itself in all; 2^-20 makes
// up for that many times over as long as no quotient underflows, which low >= 2^-100 excludes; a sum or
// difference that is subnormal is exact. NaN and infinite errors fail the comparisons.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void DepthBounds(D d, V along, V along_error, V size, V size_error, V& low, V& high) {
  low = hn::Mul(hn::Div(hn::Sub(along, along_error), hn::Add(size, size_error)), hn::Set(d, 1.0f - 0x1p-20f));
  high =
      hn::Mul(hn::Div(hn::Add(along, along_error), hn::Sub(size, size_error)), hn::Set(d, 1.0f + 0x1p-20f));
  const auto usable =
      hn::And(hn::And(hn::Gt(size, size_error), hn::Gt(along, along_error)),
              hn::And(hn::Ge(low, hn::Set(d, 0x1p-100f)), hn::Le(high, hn::Set(d, 0x1p120f))));
  low = hn::IfThenElse(usable, low, hn::Set(d, -1.0f));
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
