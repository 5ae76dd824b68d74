// A triangle's planes about one tile, in float, and what they say of its blocks of pixels. Included once per
// Highway target.

#if defined(PLUMB_PIXELS_TILE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_TILE_PLANES_INL_H_
#undef PLUMB_PIXELS_TILE_PLANES_INL_H_
#else
#define PLUMB_PIXELS_TILE_PLANES_INL_H_
#endif

#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "base/round-inl.h"
#include "hwy/highway.h"
#include "pixels/screen_triangle.h"
#include "pixels/tile.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Block centres from the tile's, in pixels; and pixel centres from their block's.
struct CentreOffsets {
  alignas(64) float block_x[kTileBlocks * kTileBlocks];
  alignas(64) float block_y[kTileBlocks * kTileBlocks];
  alignas(64) float pixel_x[kBlockPixels];
  alignas(64) float pixel_y[kBlockPixels];

  constexpr CentreOffsets() : block_x(), block_y(), pixel_x(), pixel_y() {
    for (int i = 0; i < kTileBlocks * kTileBlocks; ++i) {
      block_x[i] = static_cast<float>(i % kTileBlocks * kBlockPx) - 14.0f;
      block_y[i] = static_cast<float>(i / kTileBlocks * kBlockPx) - 14.0f;
    }
    for (int i = 0; i < kBlockPixels; ++i) {
      pixel_x[i] = static_cast<float>(i % kBlockPx) - 1.5f;
      pixel_y[i] = static_cast<float>(i / kBlockPx) - 1.5f;
    }
  }
};
static_assert(kTileBlocks == 8 && kBlockPx == 4);
constexpr CentreOffsets kCentres;

// The bound. With u = 2^-24 and M = |c| + 16 (|a| + |b|), c the plane's value at the tile's centre, a
// pixel's value is computed from a block's and a pixel's offsets, |x' + x''|, |y' + y''| <= 15.5, as
//     fl(fl(fl(c + b y') + a x') + b y'') + a x''
// with one rounding a step where it is fused and two where not:
//     the four sums, each below M: 4 u M     the products: 15.5 u (|a| + |b|) < u M
//     a, b and c rounded to float: u M
// so 6 u M. A half more covers the second order and the roundings in double (the tile's centre may
// lie outside the frame, beyond what ScreenTriangle::error speaks of, but not beyond 2 M). What
// underflows is far below 2^-140, which is added.
//
// For 1/t, ScreenTriangle's relative error is u / 4. And two hits whose bounds do not meet must also
// round to different depths: 1.1 u of 1/t more on either side makes 1/t differ by 2.2 u of itself, t by more
// than the spacing of floats (below kGreatestInverse; above it t comes near the subnormal numbers, and
// nothing is certain).
constexpr double kTileU = 0x1p-24;
HWY_ALIGN constexpr double kPlaneRelative[4] = {6.5 * kTileU, 6.5 * kTileU, 6.5 * kTileU, 7.9 * kTileU};
constexpr float kGreatestInverse = 0x1p100f;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
HWY_ALIGN constexpr double kPlaneLimit[4] = {kNoLimit, kNoLimit, kNoLimit, double{kGreatestInverse}};

/// ScreenTriangle's planes about a tile's centre; `error` is now everything between a value computed at a
/// pixel and the exact one for its ray. `grow` is that and how far the plane rises from a block's centre to
/// its pixels' centres.
struct TilePlanes {
  HWY_ALIGN float a[4];
  HWY_ALIGN float b[4];
  HWY_ALIGN float c[4];
  HWY_ALIGN float error[4];
  HWY_ALIGN float grow[4];
  float nearest;
};

// About the tile whose upper left pixel is (tile_x, tile_y). False where no pixel of the tile can be covered.
HWY_INLINE bool PlacePlanes(const ScreenTriangle& triangle, int tile_x, int tile_y, TilePlanes& planes) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  const auto x = hn::Set(d, tile_x + 0.5 * (kTilePx - 1));
  const auto y = hn::Set(d, tile_y + 0.5 * (kTilePx - 1));
  const auto infinity = hn::Set(d, kNoLimit);
  auto outside = hn::FirstN(df, 0);
  for (size_t lane = 0; lane < 4; lane += hn::Lanes(d)) {
    const auto a = hn::Load(d, triangle.a + lane);
    const auto b = hn::Load(d, triangle.b + lane);
    const auto c = hn::MulAdd(b, y, hn::MulAdd(a, x, hn::Load(d, triangle.c + lane)));
    const auto slope = hn::Add(hn::Abs(a), hn::Abs(b));
    const auto greatest = hn::MulAdd(slope, hn::Set(d, 16.0), hn::Abs(c));
    const auto given = hn::PromoteTo(d, hn::Load(df, triangle.error + lane));
    const auto sum = hn::MulAdd(greatest, hn::Load(d, kPlaneRelative + lane), given);
    // Rounded up when it becomes a float. NaN becomes infinity: nothing is certain.
    const auto padded = hn::MulAdd(sum, hn::Set(d, 1.0 + 0x1p-20), hn::Set(d, 0x1p-140));
    const auto usable = hn::Lt(hn::Add(greatest, padded), hn::Load(d, kPlaneLimit + lane));
    const auto error = RoundToFloat(df, hn::IfThenElse(usable, padded, infinity));
    const auto rise = RoundToFloat(df, hn::Mul(slope, hn::Set(d, 1.0001)));
    const auto centre = RoundToFloat(df, c);
    hn::Store(RoundToFloat(df, a), df, planes.a + lane);
    hn::Store(RoundToFloat(df, b), df, planes.b + lane);
    hn::Store(centre, df, planes.c + lane);
    hn::Store(error, df, planes.error + lane);
    hn::Store(hn::MulAdd(rise, hn::Set(df, 1.5f), error), df, planes.grow + lane);
    // The fourth plane, 1/t, must not be below 0 in all of the tile either.
    const auto most = hn::MulAdd(rise, hn::Set(df, 15.5f), hn::Add(centre, error));
    outside = hn::Or(outside, hn::Lt(most, hn::Zero(df)));
  }
  planes.nearest = triangle.nearest;
  return hn::AllFalse(df, outside);
}

// Turns the edges to the triangle's other side.
inline void TurnEdges(TilePlanes& planes) {
  for (int i = 0; i < 3; ++i) {
    planes.a[i] = -planes.a[i];
    planes.b[i] = -planes.b[i];
    planes.c[i] = -planes.c[i];
  }
}

// Of the blocks [first, first + Lanes) of a tile: those that may hold a pixel that the triangle covers and
// that `low`, a bound of 1/t, does not hide; and those whose every pixel it certainly covers.
template <class D>
HWY_INLINE void TestBlocks(D d, const TilePlanes& planes, size_t first, const float* low, hn::Mask<D>& open,
                           hn::Mask<D>& full) {
  const auto x = hn::Load(d, kCentres.block_x + first);
  const auto y = hn::Load(d, kCentres.block_y + first);
  // Not below: NaN keeps a block open.
  auto closed = hn::FirstN(d, 0);
  auto partly = hn::FirstN(d, 0);
  for (int i = 0; i < 3; ++i) {
    const auto value = hn::MulAdd(hn::Set(d, planes.a[i]), x,
                                  hn::MulAdd(hn::Set(d, planes.b[i]), y, hn::Set(d, planes.c[i])));
    const auto grow = hn::Set(d, planes.grow[i]);
    closed = hn::Or(closed, hn::Lt(hn::Add(value, grow), hn::Zero(d)));
    partly = hn::Or(partly, hn::Not(hn::Gt(value, grow)));
  }
  const auto inverse =
      hn::MulAdd(hn::Set(d, planes.a[3]), x, hn::MulAdd(hn::Set(d, planes.b[3]), y, hn::Set(d, planes.c[3])));
  const auto high = hn::Min(hn::Add(inverse, hn::Set(d, planes.grow[3])), hn::Set(d, planes.nearest));
  closed = hn::Or(closed, hn::Lt(high, hn::Load(d, low + first)));
  open = hn::Not(closed);
  full = hn::AndNot(partly, open);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
