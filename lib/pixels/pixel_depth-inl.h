// Exact depths of many pixels at once: double with a proven bound. Included once per Highway target.

#if defined(PLUMB_PIXELS_PIXEL_DEPTH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_PIXEL_DEPTH_INL_H_
#undef PLUMB_PIXELS_PIXEL_DEPTH_INL_H_
#else
#define PLUMB_PIXELS_PIXEL_DEPTH_INL_H_
#endif

#include <limits>

#include "base/round-inl.h"
#include "hwy/highway.h"
#include "plumb/camera.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One component of the pixels' directions, as scene/pixel_direction.h has it: each operation rounded, the
// result rounded to float. `column` and `row` are x + 0.5 and y + 0.5.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V DirectionComponent(D d, V column, V row, double corner, double du, double dv) {
  const hn::Rebind<float, D> df;
  const V sum =
      hn::Add(hn::Add(hn::Set(d, corner), hn::Mul(column, hn::Set(d, du))), hn::Mul(row, hn::Set(d, dv)));
  return hn::PromoteTo(d, RoundToFloat(df, sum));
}

// RN32(t_num / (normal.d)) for the pixels' float directions d, where that is certain, finite and above 0.
//
// With u = 2^-53, the denominator is off by normal_error |d|_1 (the dot product's own rounding included) and
// t_num by t_num_relative of itself, so the quotient by the sum of these two relative errors, up
// to second order, and by 3 u for the reciprocal, the product and the sum that gives an end of the interval.
// Rounding is monotonic: where both ends round to the same float, so does everything between. NaN compares
// as not equal.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void QuotientDepth(D d, V den, V t_num, V t_num_relative, V den_error,
                              hn::Vec<hn::Rebind<float, D>>& t, hn::Mask<hn::Rebind<float, D>>& certain) {
  const hn::Rebind<float, D> df;
  const V inverse = hn::Div(hn::Set(d, 1.0), den);
  const V quotient = hn::Mul(t_num, inverse);
  const V sum = hn::MulAdd(den_error, hn::Abs(inverse), t_num_relative);
  // The factor 1.02 holds for small errors only.
  const V relative = hn::IfThenElse(hn::Lt(sum, hn::Set(d, 0x1p-10)), sum,
                                    hn::Set(d, std::numeric_limits<double>::infinity()));
  const V slack = hn::Mul(quotient, hn::MulAdd(relative, hn::Set(d, 1.02), hn::Set(d, 5.0 * 0x1p-53)));
  t = RoundToFloat(df, hn::Sub(quotient, slack));
  const auto other = RoundToFloat(df, hn::Add(quotient, slack));
  const auto in_range =
      hn::And(hn::Gt(t, hn::Zero(df)), hn::Lt(t, hn::Set(df, std::numeric_limits<float>::infinity())));
  certain = hn::And(hn::Eq(t, other), in_range);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
