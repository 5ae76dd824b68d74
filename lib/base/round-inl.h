// base/round.h's rounding by the vector. Included once per Highway target.

#if defined(PLUMB_BASE_ROUND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_BASE_ROUND_INL_H_
#undef PLUMB_BASE_ROUND_INL_H_
#else
#define PLUMB_BASE_ROUND_INL_H_
#endif

#include "base/round.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// RN32 lane by lane. Highway's DemoteTo is that but on its emulated targets, where what should become
// infinite becomes the greatest float.
template <class DF, class V>
HWY_INLINE hn::Vec<DF> RoundToFloat(DF df, V value) {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
  const hn::Rebind<double, DF> d;
  HWY_ALIGN double from[hn::MaxLanes(d)];
  HWY_ALIGN float to[hn::MaxLanes(d)];
  hn::Store(value, d, from);
  for (size_t i = 0; i < hn::MaxLanes(d); ++i) to[i] = round_to_float(from[i]);
  return hn::Load(df, to);
#else
  return hn::DemoteTo(df, value);
#endif
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
