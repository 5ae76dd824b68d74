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
// result rounded to float. It is made of a part of its column, x + 0.5, and one of its row, y + 0.5.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V DirectionOfColumn(D d, V column, double corner, double du) {
  return hn::Add(hn::Set(d, corner), hn::Mul(column, hn::Set(d, du)));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V DirectionOfRow(D d, V row, double dv) {
  return hn::Mul(row, hn::Set(d, dv));
}

template <class D, class V = hn::Vec<D>>
HWY_INLINE V Direction(D d, V of_column, V of_row) {
  const hn::Rebind<float, D> df;
  return hn::PromoteTo(d, RoundToFloat(df, hn::Add(of_column, of_row)));
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
