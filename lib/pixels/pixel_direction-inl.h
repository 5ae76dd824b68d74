// Directions of many pixels' rays at once. Included once per Highway target.

#if defined(PLUMB_PIXELS_PIXEL_DIRECTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_PIXEL_DIRECTION_INL_H_
#undef PLUMB_PIXELS_PIXEL_DIRECTION_INL_H_
#else
#define PLUMB_PIXELS_PIXEL_DIRECTION_INL_H_
#endif

#include "base/round-inl.h"
#include "hwy/highway.h"

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

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
