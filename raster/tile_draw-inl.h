// Draws triangles into a tile: blocks of 4 x 4 pixels rejected a vector at a time, then the pixels of those
// that are left, 16 at once. Included once per Highway target.
//
// Everything here is a filter in float: a pixel is taken, or passed over, only where that is
// certain; the others are decided exactly. Hence the order of triangles does not matter.

#if defined(PLUMB_RASTER_TILE_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_TILE_DRAW_INL_H_
#undef PLUMB_RASTER_TILE_DRAW_INL_H_
#else
#define PLUMB_RASTER_TILE_DRAW_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <span>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
#include "pixels/tile_planes-inl.h"
#include "pixels/tile_state-inl.h"
#include "raster/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Decides pixels of a block that the triangle certainly covers, but at a depth too near to the winner's.
inline void DecideDepths(const TileTask& task, TileState& state, int block, std::uint32_t triangle,
                         std::uint32_t pixels) {
  const int first = block * kBlockPixels;
  LearnBlock(task, state, block, pixels);
  HWY_ALIGN float t[kBlockPixels];
  const std::uint32_t certain = BlockDepths(task, block, task.triangles[triangle], t);
  const std::uint32_t id = task.id_of(triangle);
  for (std::uint32_t bits = pixels; bits != 0; bits &= bits - 1) {
    const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
    const int offset = first + i;
    if ((certain >> i & 1) == 0) {
      decide_pixel(task, state, offset, triangle);
    } else if (t[i] < state.t[offset] || (t[i] == state.t[offset] && id < state.id[offset])) {
      state.winner[offset] = state.known[offset] = triangle;
      state.t[offset] = t[i];
      state.id[offset] = id;
    }
  }
  SetBounds(state, block, pixels);
}

// Decides pixels of a block that the triangle may or may not cover.
inline void DecidePixels(const TileTask& task, TileState& state, int block, std::uint32_t triangle,
                         std::uint32_t pixels) {
  LearnBlock(task, state, block, pixels);
  for (std::uint32_t bits = pixels; bits != 0; bits &= bits - 1) {
    const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
    decide_pixel(task, state, block * kBlockPixels + i, triangle);
  }
  SetBounds(state, block, pixels);
}

// Draws the triangle into a block; with `kFull` it certainly covers every pixel.
template <bool kFull>
HWY_INLINE void DrawBlock(const TileTask& task, const TilePlanes& planes, std::uint32_t triangle, int block,
                          TileState& state) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  HWY_ALIGN float centre[4];  // the planes at the block's centre
  const hn::CappedTag<float, 4> d4;
  for (size_t i = 0; i < 4; i += hn::Lanes(d4)) {
    const auto row = hn::MulAdd(hn::Load(d4, planes.b + i), hn::Set(d4, kCentres.block_y[block]),
                                hn::Load(d4, planes.c + i));
    hn::Store(hn::MulAdd(hn::Load(d4, planes.a + i), hn::Set(d4, kCentres.block_x[block]), row), d4,
              centre + i);
  }
  std::uint32_t won_bits = 0, depth_open = 0, edge_open = 0;
  for (size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
    const auto px = hn::Load(d, kCentres.pixel_x + lane);
    const auto py = hn::Load(d, kCentres.pixel_y + lane);
    const auto value = [&](int i) HWY_ATTR {
      return hn::MulAdd(hn::Set(d, planes.a[i]), px,
                        hn::MulAdd(hn::Set(d, planes.b[i]), py, hn::Set(d, centre[i])));
    };
    const size_t offset = static_cast<size_t>(block * kBlockPixels) + lane;
    const auto error = hn::Set(d, planes.error[3]);
    const auto inverse = value(3);
    const auto low = hn::Sub(inverse, error);
    const auto high = hn::Add(inverse, error);
    auto closed = hn::Lt(high, hn::Load(d, state.inverse_low + offset));
    auto covered = hn::Not(closed);
    if constexpr (!kFull) {
      for (int i = 0; i < 3; ++i) {
        const auto edge = value(i);
        closed = hn::Or(closed, hn::Lt(edge, hn::Set(d, -planes.error[i])));
        covered = hn::And(covered, hn::Gt(edge, hn::Set(d, planes.error[i])));
      }
    }
    const auto won = hn::And(covered, hn::Gt(low, hn::Load(d, state.inverse_high + offset)));
    hn::BlendedStore(low, won, d, state.inverse_low + offset);
    hn::BlendedStore(high, won, d, state.inverse_high + offset);
    hn::BlendedStore(hn::Set(du, triangle), hn::RebindMask(du, won), du, state.winner + offset);
    won_bits |= MaskBits(d, won) << lane;
    depth_open |= MaskBits(d, hn::AndNot(won, covered)) << lane;
    if constexpr (!kFull) edge_open |= MaskBits(d, hn::Not(hn::Or(closed, covered))) << lane;
  }
  if ((won_bits | depth_open | edge_open) == 0) return;
  if (HWY_UNLIKELY((depth_open | edge_open) != 0)) {
    if (task.triangles[triangle].side_open) {
      edge_open |= depth_open;
      depth_open = 0;
    }
    if (depth_open != 0) DecideDepths(task, state, block, triangle, depth_open);
    if (edge_open != 0) DecidePixels(task, state, block, triangle, edge_open);
  }
  UpdateBlock(state, block);
}

// The blocks that hold pixels of the triangle's box, one bit each.
HWY_INLINE std::uint64_t BoxBlocks(const TileTask& task, const ScreenTriangle& triangle, int& row0,
                                   int& row1) {
  const int column0 = (std::max(triangle.x0, task.x) - task.x) / kBlockPx;
  const int column1 = (std::min(triangle.x1, task.x + kTilePx - 1) - task.x) / kBlockPx;
  row0 = (std::max(triangle.y0, task.y) - task.y) / kBlockPx;
  row1 = (std::min(triangle.y1, task.y + kTilePx - 1) - task.y) / kBlockPx;
  const std::uint64_t columns = (2u << column1) - (1u << column0);
  const std::uint64_t rows = (~std::uint64_t{0} >> (8 * (7 - row1))) & (~std::uint64_t{0} << (8 * row0));
  return columns * 0x0101010101010101u & rows;
}

HWY_INLINE void DrawPlaced(const TileTask& task, const TilePlanes& planes, std::uint32_t index,
                           TileState& state) {
  const hn::CappedTag<float, 16> d;
  int row0 = 0, row1 = 0;
  const std::uint64_t box = BoxBlocks(task, task.triangles[index], row0, row1);
  const size_t lanes = hn::Lanes(d);
  const size_t end = 8 * static_cast<size_t>(row1 + 1);
  bool drawn = false;
  for (size_t first = 8 * static_cast<size_t>(row0) / lanes * lanes; first < end; first += lanes) {
    auto open = hn::FirstN(d, 0);
    auto full = hn::FirstN(d, 0);
    TestBlocks(d, planes, first, state.block_low, open, full);
    const std::uint32_t full_bits = MaskBits(d, full);
    for (std::uint32_t bits = MaskBits(d, open) & static_cast<std::uint32_t>(box >> first); bits != 0;
         bits &= bits - 1) {
      const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
      const int block = static_cast<int>(first + i);
      if ((full_bits >> i & 1) != 0) {
        DrawBlock<true>(task, planes, index, block, state);
      } else {
        DrawBlock<false>(task, planes, index, block, state);
      }
      drawn = true;
    }
  }
  if (drawn) UpdateTile(state);
}

HWY_INLINE void DrawTriangle(const TileTask& task, std::uint32_t index, TileState& state) {
  const ScreenTriangle& triangle = task.triangles[index];
  if (triangle.x0 >= task.x + kTilePx || triangle.x1 < task.x || triangle.y0 >= task.y + kTilePx ||
      triangle.y1 < task.y)
    return;
  TilePlanes planes;
  const bool met = PlacePlanes(triangle, task.x, task.y, planes);
  if (met) DrawPlaced(task, planes, index, state);
  if (HWY_UNLIKELY(triangle.side_open)) {
    TurnEdges(planes);
    DrawPlaced(task, planes, index, state);
  }
}

inline void DrawEntries(const TileTask& task, std::span<const BinEntry> entries, TileState& state) {
  for (const BinEntry& entry : entries) {
    if (entry.nearest < state.tile_low) continue;  // hidden in all of the tile
    DrawTriangle(task, entry.triangle, state);
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
