// Depths of a block's pixels in a plane across an axis (exact/axis_plane.h), ties included. Included once per
// Highway target.

#if defined(PLUMB_PIXELS_AXIS_DEPTHS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_AXIS_DEPTHS_INL_H_
#undef PLUMB_PIXELS_AXIS_DEPTHS_INL_H_
#else
#define PLUMB_PIXELS_AXIS_DEPTHS_INL_H_
#endif

#include <cstddef>
#include <cstdint>

#include "base/mask_bits-inl.h"
#include "base/round-inl.h"
#include "exact/axis_plane.h"
#include "hwy/highway.h"
#include "pixels/tile.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// RN32 of distance / direction for the pixels whose bit is set, stored to `t`, where it is certain, finite
// and above 0; returns those bits. `direction` has that component of each pixel's direction.
//
// Let q be the quotient rounded to double. A midpoint of floats is a double, and rounding is monotonic:
// unless q is one, q lies on the same side of each as the quotient does, and rounds to the same float. If q
// is a midpoint, its 25 bits times the direction's 24 are exact: where that is the distance the quotient is
// the midpoint itself. Below 2^-126, where midpoints have fewer bits, nothing is certain.
inline std::uint32_t AxisDepths(double distance, const double direction[kBlockPixels], std::uint32_t wanted,
                                float* t) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const hn::RebindToUnsigned<decltype(d)> du;
  std::uint32_t certain = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const auto along = hn::Load(d, direction + lane);
    const auto quotient = hn::Div(hn::Set(d, distance), along);
    const auto dropped = hn::And(hn::BitCast(du, quotient), hn::Set(du, 0x1fffffffu));
    const auto apart = hn::RebindMask(d, hn::Ne(dropped, hn::Set(du, 0x10000000u)));
    const auto tie = hn::Eq(hn::Mul(quotient, along), hn::Set(d, distance));
    const auto in_range =
        hn::And(hn::Ge(quotient, hn::Set(d, 0x1p-126)), hn::Lt(quotient, hn::Set(d, 0x1p128 - 0x1p103)));
    const std::uint32_t bits = MaskBits(d, hn::And(hn::Or(apart, tie), in_range)) & (wanted >> lane);
    hn::BlendedStore(RoundToFloat(df, quotient), MaskOfBits(df, bits), df, t + lane);
    certain |= bits << lane;
  }
  return certain;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
