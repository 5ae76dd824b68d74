// Draws triangles into a tile: blocks of 4 x 4 pixels rejected eight at a time, then the pixels of those that
// are left, 16 at once. Included once per Highway target.
//
// Everything here is a filter in float: a pixel is taken, or passed over, only where that is
// certain; all others go to TileState::decide, which is exact. Hence the order of triangles does not matter.

#if defined(PLUMB_RASTER_TILE_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_TILE_DRAW_INL_H_
#undef PLUMB_RASTER_TILE_DRAW_INL_H_
#else
#define PLUMB_RASTER_TILE_DRAW_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
#include "raster/tile.h"
#include "raster/tile_state.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Pixel centres from their block's centre, and block centres from their row's, in pixels.
HWY_ALIGN constexpr float kPixelX[16] = {-1.5f, -0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f,
                                         -1.5f, -0.5f, 0.5f, 1.5f, -1.5f, -0.5f, 0.5f, 1.5f};
HWY_ALIGN constexpr float kPixelY[16] = {-1.5f, -1.5f, -1.5f, -1.5f, -0.5f, -0.5f, -0.5f, -0.5f,
                                         0.5f,  0.5f,  0.5f,  0.5f,  1.5f,  1.5f,  1.5f,  1.5f};
HWY_ALIGN constexpr float kBlockX[8] = {-14.0f, -10.0f, -6.0f, -2.0f, 2.0f, 6.0f, 10.0f, 14.0f};

// A plane about the tile's centre in float; `error` covers everything between a float computed here and
// the exact value at the pixel's ray.
struct TilePlane {
  float a, b, c, error;
};

// The bound. With u = 2^-24, a pixel's value is computed as
//     fl(fl(fl(c + b y') + a x') + b y'') + a x''
// from a block's and a pixel's offsets, |x' + x''|, |y' + y''| < 16, each step one rounding if fused and two
// if not, of values below M = |c| + 16 (|a| + |b|) and products below 14 (|a| + |b|): at most 4 u M +
// 4 u * 16 (|a| + |b|); a, b, c themselves are rounded: u M. So 9 u M, and 10 u M below.
inline float EvaluationError(double a, double b, double c) {
  return static_cast<float>(10.0 * 0x1p-24 * (std::fabs(c) + 16.0 * (std::fabs(a) + std::fabs(b))));
}

// Rounded up, with room for the second order.
inline float RoundUp(double value) { return static_cast<float>(value * (1.0 + 0x1p-20)) + 0x1p-140f; }

inline TilePlane PlaceEdge(const Plane& plane, double x, double y) {
  const double c = (plane.c + plane.a * x) + plane.b * y;
  return {static_cast<float>(plane.a), static_cast<float>(plane.b), static_cast<float>(c),
          RoundUp(plane.error + double{EvaluationError(plane.a, plane.b, c)})};
}

// Two hits whose 1/t differ by more than their errors must also round to different floats: 4 u of the
// greatest 1/t in the tile on either side does that, as TileState's bounds do on theirs. Where 1/t may leave
// the range of TileState nothing is certain.
inline TilePlane PlaceDepth(const TriangleSetup& record, double x, double y) {
  const Plane& plane = record.depth;
  const double c = (plane.c + plane.a * x) + plane.b * y;
  const double greatest = std::fabs(c) + 16.0 * (std::fabs(plane.a) + std::fabs(plane.b));
  const double error = plane.error + record.depth_relative * greatest + 4.0 * 0x1p-24 * greatest;
  if (!(greatest + error < double{TileState::kGreatestInverse}))
    return {0.0f, 0.0f, 0.0f, std::numeric_limits<float>::infinity()};
  return {static_cast<float>(plane.a), static_cast<float>(plane.b), static_cast<float>(c),
          RoundUp(error + double{EvaluationError(plane.a, plane.b, c)})};
}

struct TileTriangle {
  TilePlane edge[3];
  TilePlane depth;
  std::uint32_t index;
};

// The blocks of a row of eight that a pixel of the triangle may win, one bit each.
HWY_INLINE std::uint32_t TestBlocks(const TileTriangle& triangle, float y, const float* block_low) {
  const hn::CappedTag<float, 8> d;
  // From a block's centre to a pixel's, an edge function grows by at most 1.5 (|a| + |b|), which is 1.5 but
  // for roundings; 1/t likewise.
  const auto grow = [](const TilePlane& p) { return 1.5001f * (std::fabs(p.a) + std::fabs(p.b)) + p.error; };
  std::uint32_t blocks = 0;
  for (size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    const auto x = hn::Load(d, kBlockX + lane);
    // Not less than: NaN keeps a block.
    auto rejected = hn::FirstN(d, 0);
    for (const TilePlane& edge : triangle.edge) {
      const auto value = hn::MulAdd(hn::Set(d, edge.a), x, hn::Set(d, edge.b * y + edge.c));
      rejected = hn::Or(rejected, hn::Lt(hn::Add(value, hn::Set(d, grow(edge))), hn::Zero(d)));
    }
    const TilePlane& depth = triangle.depth;
    const auto inverse = hn::MulAdd(hn::Set(d, depth.a), x, hn::Set(d, depth.b * y + depth.c));
    const auto hidden = hn::Lt(hn::Add(inverse, hn::Set(d, grow(depth))), hn::Load(d, block_low + lane));
    blocks |= MaskBits(d, hn::Not(hn::Or(rejected, hidden))) << lane;
  }
  return blocks;
}

HWY_INLINE void DrawBlock(const TileTriangle& triangle, float x, float y, int block, TileState& state) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const int first = block * kBlockPixels;
  bool changed = false;
  for (size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
    const auto px = hn::Load(d, kPixelX + lane);
    const auto py = hn::Load(d, kPixelY + lane);
    auto missed = hn::FirstN(d, 0);
    auto uncertain = hn::FirstN(d, 0);
    for (const TilePlane& edge : triangle.edge) {
      const auto base = hn::Set(d, edge.c + edge.b * y + edge.a * x);
      const auto value = hn::MulAdd(hn::Set(d, edge.a), px, hn::MulAdd(hn::Set(d, edge.b), py, base));
      missed = hn::Or(missed, hn::Lt(value, hn::Set(d, -edge.error)));
      uncertain = hn::Or(uncertain, hn::Not(hn::Gt(value, hn::Set(d, edge.error))));
    }
    const TilePlane& depth = triangle.depth;
    const auto base = hn::Set(d, depth.c + depth.b * y + depth.a * x);
    const auto inverse = hn::MulAdd(hn::Set(d, depth.a), px, hn::MulAdd(hn::Set(d, depth.b), py, base));
    const auto error = hn::Set(d, depth.error);
    const auto low = hn::Sub(inverse, error);
    const auto high = hn::Add(inverse, error);

    const size_t offset = static_cast<size_t>(first) + lane;
    const auto hidden = hn::Lt(high, hn::Load(d, state.inverse_low + offset));
    const auto nearer = hn::Gt(low, hn::Load(d, state.inverse_high + offset));
    const auto open = hn::Not(hn::Or(missed, hidden));
    const auto won = hn::And(hn::AndNot(uncertain, nearer), open);
    const std::uint32_t won_bits = MaskBits(d, won);
    if (won_bits != 0) {
      hn::BlendedStore(low, won, d, state.inverse_low + offset);
      hn::BlendedStore(high, won, d, state.inverse_high + offset);
      hn::BlendedStore(hn::Set(du, triangle.index), hn::RebindMask(du, won), du, state.index + offset);
      changed = true;
    }
    for (std::uint32_t bits = MaskBits(d, open) & ~won_bits; bits != 0; bits &= bits - 1) {
      state.decide(static_cast<int>(offset + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)), triangle.index);
      changed = true;
    }
  }
  if (changed) state.update_block(block);
}

HWY_INLINE void DrawTriangle(const TileTask& task, const TriangleSetup& record, TileState& state) {
  TileTriangle triangle;
  const double x = task.x + 0.5 * (kTilePx - 1);
  const double y = task.y + 0.5 * (kTilePx - 1);
  for (int i = 0; i < 3; ++i) triangle.edge[i] = PlaceEdge(record.edge[i], x, y);
  triangle.depth = PlaceDepth(record, x, y);
  triangle.index = record.index;
  const int column0 = (std::max(record.x0, task.x) - task.x) / kBlockPx;
  const int column1 = (std::min(record.x1, task.x + kTilePx - 1) - task.x) / kBlockPx;
  const int row0 = (std::max(record.y0, task.y) - task.y) / kBlockPx;
  const int row1 = (std::min(record.y1, task.y + kTilePx - 1) - task.y) / kBlockPx;
  const std::uint32_t columns = (2u << column1) - (1u << column0);
  for (int row = row0; row <= row1; ++row) {
    std::uint32_t blocks = TestBlocks(triangle, kBlockX[row], state.block_low + row * kTileBlocks) & columns;
    for (; blocks != 0; blocks &= blocks - 1) {
      const int column = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(blocks));
      DrawBlock(triangle, kBlockX[column], kBlockX[row], row * kTileBlocks + column, state);
    }
  }
}

inline void DrawTileRecords(const TileTask& task, std::span<const TriangleSetup> records,
                            std::span<const std::uint32_t> list, TilePixels& pixels) {
  TileState state(task, pixels);
  for (const std::uint32_t i : list) DrawTriangle(task, records[i], state);
  state.finish();
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
