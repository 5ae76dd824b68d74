// A triangle's planes about one tile, in float, and what they say of its blocks of pixels. Included once per
// Highway target.

#if defined(PLUMB_PIXELS_TILE_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_TILE_PLANES_INL_H_
#undef PLUMB_PIXELS_TILE_PLANES_INL_H_
#else
#define PLUMB_PIXELS_TILE_PLANES_INL_H_
#endif

#include <algorithm>
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
// pixel's value is computed from its offsets from there, |x|, |y| <= 15.5, which are exact, as
//     fl(fl(c + b y) + a x)
// with one rounding a step where it is fused and two where not:
//     the two sums, each below M: 2 u M     the products: 15.5 u (|a| + |b|) < u M
//     a, b and c rounded to float: u M
// so 4 u M. A half more covers the second order and the roundings in double (the tile's centre may
// lie outside the frame, beyond what ScreenTriangle::error speaks of, but not beyond 2 M). What
// underflows is far below 2^-140, which is added.
//
// For 1/t, ScreenTriangle's relative error is u / 4. And two hits whose bounds do not meet must
// also round to different depths: 1.1 u of 1/t more on either side makes 1/t differ by 2.2 u of itself, t by
// more than the spacing of floats (below kGreatestInverse; above it t comes near the subnormal numbers, and
// nothing is certain).
constexpr double kTileU = 0x1p-24;
HWY_ALIGN constexpr double kPlaneRelative[4] = {4.5 * kTileU, 4.5 * kTileU, 4.5 * kTileU, 5.9 * kTileU};
constexpr float kGreatestInverse = 0x1p100f;
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
HWY_ALIGN constexpr double kPlaneLimit[4] = {kNoLimit, kNoLimit, kNoLimit, double{kGreatestInverse}};

HWY_ALIGN constexpr double kOutsideRelative[4] = {0x1p-49, 0x1p-49, 0x1p-49, 1.5 * kTileU};

// A plane about a tile's centre (x, y), as TileTriangle has it. `given` is ScreenTriangle's error.
template <class D, class V = hn::Vec<D>, class VF = hn::Vec<hn::Rebind<float, D>>>
HWY_INLINE void PlacePlane(D d, V a, V b, V c, V given, V x, V y, V relative, V limit, VF& centre,
                           VF& error) {
  const hn::Rebind<float, D> df;
  const V value = hn::MulAdd(b, y, hn::MulAdd(a, x, c));
  const V slope = hn::Add(hn::Abs(a), hn::Abs(b));
  const V greatest = hn::MulAdd(slope, hn::Set(d, 16.0), hn::Abs(value));
  const V sum = hn::MulAdd(greatest, relative, given);
  // Rounded up when it becomes a float. NaN becomes infinity: nothing is certain.
  const V padded = hn::MulAdd(sum, hn::Set(d, 1.0 + 0x1p-20), hn::Set(d, 0x1p-140));
  const auto usable = hn::Lt(hn::Add(greatest, padded), limit);
  centre = RoundToFloat(df, value);
  error = RoundToFloat(df, hn::IfThenElse(usable, padded, hn::Set(d, kNoLimit)));
}

// Places a triangle about the tile whose upper left pixel is (tile_x, tile_y). Their pixels must meet.
HWY_INLINE void PlaceTriangle(const ScreenTriangle& from, int tile_x, int tile_y, TileTriangle& to) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  const auto x = hn::Set(d, tile_x + 0.5 * (kTilePx - 1));
  const auto y = hn::Set(d, tile_y + 0.5 * (kTilePx - 1));
  for (size_t lane = 0; lane < 4; lane += hn::Lanes(d)) {
    const auto a = hn::LoadU(d, from.a + lane), b = hn::LoadU(d, from.b + lane);
    auto centre = hn::Zero(df), error = hn::Zero(df);
    PlacePlane(d, a, b, hn::LoadU(d, from.c + lane), hn::PromoteTo(d, hn::Load(df, from.error + lane)), x, y,
               hn::Load(d, kPlaneRelative + lane), hn::Load(d, kPlaneLimit + lane), centre, error);
    hn::Store(RoundToFloat(df, a), df, to.a + lane);
    hn::Store(RoundToFloat(df, b), df, to.b + lane);
    hn::Store(centre, df, to.c + lane);
    hn::Store(error, df, to.error + lane);
  }
  to.edge_error = std::max(to.error[0], std::max(to.error[1], to.error[2]));
  to.nearest = from.nearest;
  to.x0 = static_cast<std::uint8_t>(std::max(from.x0 - tile_x, 0));
  to.y0 = static_cast<std::uint8_t>(std::max(from.y0 - tile_y, 0));
  to.x1 = static_cast<std::uint8_t>(std::min(from.x1 - tile_x, kTilePx - 1));
  to.y1 = static_cast<std::uint8_t>(std::min(from.y1 - tile_y, kTilePx - 1));
}

// The triangle as seen from its other side.
inline void TurnEdges(TileTriangle& triangle) {
  for (int i = 0; i < 3; ++i) {
    triangle.a[i] = -triangle.a[i];
    triangle.b[i] = -triangle.b[i];
    triangle.c[i] = -triangle.c[i];
  }
}

// By how much a plane can be above its computed value at the centre of a square within `half` pixels of it,
// and below.
HWY_INLINE void Grow(const TileTriangle& triangle, float half, float grow[4]) {
  const hn::CappedTag<float, 4> d;
  for (size_t i = 0; i < 4; i += hn::Lanes(d)) {
    const auto slope = hn::Add(hn::Abs(hn::Load(d, triangle.a + i)), hn::Abs(hn::Load(d, triangle.b + i)));
    hn::Store(hn::MulAdd(slope, hn::Set(d, 1.0001f * half), hn::Load(d, triangle.error + i)), d, grow + i);
  }
}

// Whether no pixel of the tile can be covered, or none with 1/t above `low`, as a bound of 1/t that differs
// in the rounded t too.
HWY_INLINE bool OutsideTile(const ScreenTriangle& triangle, int tile_x, int tile_y, float low) {
  const hn::CappedTag<double, 4> d;
  const hn::Rebind<float, decltype(d)> df;
  const auto x = hn::Set(d, tile_x + 0.5 * (kTilePx - 1));
  const auto y = hn::Set(d, tile_y + 0.5 * (kTilePx - 1));
  // What rounds here is far less than the 1e-4 of a slope, and for 1/t than what `relative` has to spare.
  HWY_ALIGN const double least[4] = {0.0, 0.0, 0.0, double{low}};
  auto outside = hn::FirstN(d, 0);
  for (size_t i = 0; i < 4; i += hn::Lanes(d)) {
    const auto a = hn::LoadU(d, triangle.a + i), b = hn::LoadU(d, triangle.b + i);
    const auto value = hn::MulAdd(b, y, hn::MulAdd(a, x, hn::LoadU(d, triangle.c + i)));
    const auto rise = hn::Mul(hn::Add(hn::Abs(a), hn::Abs(b)), hn::Set(d, 15.502));
    const auto error = hn::PromoteTo(d, hn::Load(df, triangle.error + i));
    const auto relative = hn::MulAdd(hn::Abs(value), hn::Load(d, kOutsideRelative + i), hn::Add(rise, error));
    outside = hn::Or(outside, hn::Lt(hn::Add(value, relative), hn::Load(d, least + i)));
  }
  return !hn::AllFalse(d, outside);
}

// Of the blocks [first, first + Lanes) of a tile: those that may hold a pixel that the triangle covers and
// that `low`, a bound of 1/t, does not hide; and those whose every pixel it certainly covers. `grow` is that
// of a block, 1.5 pixels. Also the least and the greatest bound of 1/t in each.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void TestBlocks(D d, const TileTriangle& triangle, const float grow[4], size_t first,
                           const float* hidden_below, hn::Mask<D>& open, hn::Mask<D>& full, V& low, V& high) {
  const auto x = hn::Load(d, kCentres.block_x + first);
  const auto y = hn::Load(d, kCentres.block_y + first);
  const auto value = [&](int i) HWY_ATTR {
    return hn::MulAdd(hn::Set(d, triangle.a[i]), x,
                      hn::MulAdd(hn::Set(d, triangle.b[i]), y, hn::Set(d, triangle.c[i])));
  };
  // Not below: NaN keeps a block open.
  auto closed = hn::FirstN(d, 0);
  auto partly = hn::FirstN(d, 0);
  for (int i = 0; i < 3; ++i) {
    const auto edge = value(i);
    const auto room = hn::Set(d, grow[i]);
    closed = hn::Or(closed, hn::Lt(hn::Add(edge, room), hn::Zero(d)));
    partly = hn::Or(partly, hn::Not(hn::Gt(edge, room)));
  }
  const V inverse = value(3);
  low = hn::Sub(inverse, hn::Set(d, grow[3]));
  high = hn::Add(inverse, hn::Set(d, grow[3]));
  const V nearest = hn::Min(high, hn::Set(d, triangle.nearest));
  closed = hn::Or(closed, hn::Lt(nearest, hn::Load(d, hidden_below + first)));
  open = hn::Not(closed);
  full = hn::AndNot(partly, open);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
