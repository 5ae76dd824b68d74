// Depths of many hits at once: double with a proven bound, a ray and a triangle in each lane. Included once
// per Highway target.

#if defined(PLUMB_EXACT_DEPTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_EXACT_DEPTH_INL_H_
#undef PLUMB_EXACT_DEPTH_INL_H_
#else
#define PLUMB_EXACT_DEPTH_INL_H_
#endif

#include <limits>

#include "base/round-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// T / den of one ray and one triangle a lane, and how far it may be off: infinite where the bound says
// nothing, or NaN. `ray(k)` gives the rays' origins and directions (0 to 5), `corner(k)` the triangles'
// coordinates (0 to 8), which are floats as doubles.
//
// t = T / den with T = N.a, den = N.d, N = e1 x e2 and bounds as in exact/double_stage.h, whose
// values these are: with u = 2^-53, |error of T| <= 8.01 u R L^2, |error of den| <= 7.01 u D L^2, fused or
// not. The quotient is off by (T's error + |t| den's error) / |den|, up to second order (1 % where
// both errors are small, which is asked), and by 3 u for the reciprocal, the product and the sum that gives
// an end of the interval. Nothing overflows, for |a|, |e| < 2^130 and |d| < 2^128 in any sum of three
// products; what underflows is less than 2^-1020, where the factors of a bound that is not 0 are at least
// 2^-53 and three of 2^-149, and with a bound of 0 the values are exactly 0 and their quotient is not a
// number.
//
// First what a triangle gives for all rays from a point, `eye(k)`: N, T, T's error (infinite where T says
// nothing), and L^2 times what den's error has beside it.
template <class D, class OfEye, class Corner, class V = hn::Vec<D>>
HWY_INLINE void TrianglePlane(D d, const OfEye& eye, const Corner& corner, V& nx, V& ny, V& nz, V& t_num,
                              V& t_error, V& den_factor) {
  const V v0x = corner(0), v0y = corner(1), v0z = corner(2);
  const V ax = hn::Sub(v0x, eye(0));
  const V ay = hn::Sub(v0y, eye(1));
  const V az = hn::Sub(v0z, eye(2));
  const V e1x = hn::Sub(corner(3), v0x), e1y = hn::Sub(corner(4), v0y), e1z = hn::Sub(corner(5), v0z);
  const V e2x = hn::Sub(corner(6), v0x), e2y = hn::Sub(corner(7), v0y), e2z = hn::Sub(corner(8), v0z);
  nx = hn::MulSub(e1y, e2z, hn::Mul(e1z, e2y));
  ny = hn::MulSub(e1z, e2x, hn::Mul(e1x, e2z));
  nz = hn::MulSub(e1x, e2y, hn::Mul(e1y, e2x));
  t_num = hn::MulAdd(nz, az, hn::MulAdd(ny, ay, hn::Mul(nx, ax)));

  const auto norm1 = [](V x, V y, V z)
                         HWY_ATTR { return hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z)); };
  const V extent = hn::Max(norm1(e1x, e1y, e1z), norm1(e2x, e2y, e2z));
  const V extent2 = hn::Mul(extent, extent);
  const V reach = hn::Max(hn::Abs(ax), hn::Max(hn::Abs(ay), hn::Abs(az)));
  const V error = hn::Mul(hn::Mul(reach, extent2), hn::Set(d, 8.2 * 0x1p-53));
  t_error = hn::IfThenElse(hn::Lt(error, hn::Mul(hn::Abs(t_num), hn::Set(d, 0x1p-11))), error,
                           hn::Set(d, std::numeric_limits<double>::infinity()));
  den_factor = hn::Mul(extent2, hn::Set(d, 7.2 * 0x1p-53));
}

// Then the quotient for the ray of direction (dx, dy, dz).
template <class D, class V = hn::Vec<D>>
HWY_INLINE void PlaneQuotients(D d, V dx, V dy, V dz, V nx, V ny, V nz, V t_num, V t_error, V den_factor,
                               V& quotient, V& slack) {
  const V den = hn::MulAdd(nz, dz, hn::MulAdd(ny, dy, hn::Mul(nx, dx)));
  const V size = hn::Add(hn::Add(hn::Abs(dx), hn::Abs(dy)), hn::Abs(dz));
  const V den_error = hn::Mul(size, den_factor);
  const V inverse = hn::Div(hn::Set(d, 1.0), den);
  quotient = hn::Mul(t_num, inverse);
  const V error = hn::Mul(hn::MulAdd(hn::Abs(quotient), den_error, t_error), hn::Abs(inverse));
  const V finite = hn::MulAdd(error, hn::Set(d, 1.02), hn::Mul(hn::Abs(quotient), hn::Set(d, 5.0 * 0x1p-53)));
  const auto den_known = hn::Lt(den_error, hn::Mul(hn::Abs(den), hn::Set(d, 0x1p-11)));
  slack = hn::IfThenElse(den_known, finite, hn::Set(d, std::numeric_limits<double>::infinity()));
}

template <class D, class OfRay, class Corner, class V = hn::Vec<D>>
HWY_INLINE void TriangleQuotients(D d, const OfRay& ray, const Corner& corner, V& quotient, V& slack) {
  V nx, ny, nz, t_num, t_error, den_factor;
  TrianglePlane(d, ray, corner, nx, ny, nz, t_num, t_error, den_factor);
  PlaneQuotients(d, ray(3), ray(4), ray(5), nx, ny, nz, t_num, t_error, den_factor, quotient, slack);
}

// Whether an interval whose ends round to these floats gives RN32(t) for certain, finite and above 0.
// Rounding is monotonic: where both ends round to the same float, so does everything between. NaN compares as
// not equal.
template <class DF, class VF = hn::Vec<DF>>
HWY_INLINE hn::Mask<DF> CertainDepths(DF df, VF least, VF greatest) {
  const auto in_range = hn::And(hn::Gt(least, hn::Zero(df)),
                                hn::Lt(least, hn::Set(df, std::numeric_limits<float>::infinity())));
  return hn::And(hn::Eq(least, greatest), in_range);
}

// RN32(t) of TriangleQuotients' interval, where that is certain.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void RoundQuotients(D d, V quotient, V slack, hn::Vec<hn::Rebind<float, D>>& t,
                               hn::Mask<hn::Rebind<float, D>>& certain) {
  const hn::Rebind<float, decltype(d)> df;
  t = RoundToFloat(df, hn::Sub(quotient, slack));
  certain = CertainDepths(df, t, RoundToFloat(df, hn::Add(quotient, slack)));
}

// For many rays of one triangle whose |d|_1 is at most `greatest`, the error of the quotient is at most
// |t| (a + b |t|): |1 / den| is |t / T| but for 3 u, so TriangleQuotients' bound is 1.02 (|t| den's error +
// T's error) |t / T| + 5 u |t|, with den's error at most `greatest` times den's factor.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void PlaneBounds(D d, V t_num, V t_error, V den_factor, double greatest, V& a, V& b) {
  const V inverse = hn::Div(hn::Set(d, 1.03), hn::Abs(t_num));
  a = hn::MulAdd(t_error, inverse, hn::Set(d, 6.0 * 0x1p-53));
  b = hn::Mul(hn::Mul(den_factor, hn::Set(d, greatest)), inverse);
}

// RN32 of the ends of an interval that t lies in, with those bounds. Where den's error is not small beside
// den, b |t| is not small either, and the ends round to different floats; where a quotient is below 0, so is
// t.
template <class D, class V = hn::Vec<D>, class VF = hn::Vec<hn::Rebind<float, D>>>
HWY_INLINE void PlaneEnds(D d, V dx, V dy, V dz, V nx, V ny, V nz, V t_num, V a, V b, VF& least,
                          VF& greatest) {
  const hn::Rebind<float, decltype(d)> df;
  const V den = hn::MulAdd(nz, dz, hn::MulAdd(ny, dy, hn::Mul(nx, dx)));
  const V quotient = hn::Div(t_num, den);
  const V slack = hn::Mul(quotient, hn::MulAdd(b, quotient, a));
  least = RoundToFloat(df, hn::Sub(quotient, slack));
  greatest = RoundToFloat(df, hn::Add(quotient, slack));
}

template <class D, class OfRay, class Corner>
HWY_INLINE void TriangleDepths(D d, const OfRay& ray, const Corner& corner, hn::Vec<hn::Rebind<float, D>>& t,
                               hn::Mask<hn::Rebind<float, D>>& certain) {
  hn::Vec<D> quotient, slack;
  TriangleQuotients(d, ray, corner, quotient, slack);
  RoundQuotients(d, quotient, slack, t, certain);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
