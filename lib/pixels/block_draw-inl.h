// Draws triangles into a tile: blocks of 4 x 4 pixels rejected a vector at a time, then the pixels of those
// that are left, 16 at once. Included once per Highway target.
//
// Everything here is a filter in float: a pixel is taken, or passed over, only where that is
// certain; the others are decided exactly. Hence the order of triangles does not matter.

#if defined(PLUMB_PIXELS_BLOCK_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_BLOCK_DRAW_INL_H_
#undef PLUMB_PIXELS_BLOCK_DRAW_INL_H_
#else
#define PLUMB_PIXELS_BLOCK_DRAW_INL_H_
#endif

#include <algorithm>
#include <cstdint>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
#include "pixels/tile_planes-inl.h"
#include "pixels/tile_settle-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Decides between a triangle's depths, where they are certain, and those that pixels of a block know. Bounds
// are taken anew where `asked`.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void DecideKnown(D d, TileState& state, size_t offset, std::uint32_t triangle, V depth,
                            hn::Mask<D> certain, hn::Mask<D> asked) {
  const hn::RebindToUnsigned<D> du;
  const auto id = hn::Set(du, state.drawn.id[triangle]);
  const auto known = hn::Load(d, state.t + offset);
  const auto lower_id = hn::RebindMask(d, hn::Lt(id, hn::Load(du, state.id + offset)));
  const auto before = hn::Or(hn::Lt(depth, known), hn::And(hn::Eq(depth, known), lower_id));
  const auto won = hn::And(hn::And(before, certain), asked);
  const auto won_ids = hn::RebindMask(du, won);
  hn::BlendedStore(depth, won, d, state.t + offset);
  hn::BlendedStore(id, won_ids, du, state.id + offset);
  hn::BlendedStore(hn::Set(du, triangle), won_ids, du, state.winner + offset);
  auto low = hn::Zero(d), high = hn::Zero(d);
  BoundsOf(d, hn::IfThenElse(won, depth, known), low, high);
  hn::BlendedStore(low, asked, d, state.inverse_low + offset);
  hn::BlendedStore(high, asked, d, state.inverse_high + offset);
}

// Decides pixels of a block that the triangle certainly covers, at depths that are not certain.
template <class Triangles>
HWY_NOINLINE inline void DecideTies(const TileView& view, const Triangles& triangles, TileState& state,
                                    int block, std::uint32_t triangle, std::uint32_t pixels) {
  const size_t first = static_cast<size_t>(block) * kBlockPixels;
  const hn::CappedTag<float, 16> d;
  const PlacedTriangle placed = Placed(triangles, state, triangle);
  HWY_ALIGN float t[kBlockPixels] = {};
  const std::uint32_t ties = BlockTies(view, state, block, placed.corners, pixels, t);
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const auto tied = MaskOfBits(d, ties >> lane);
    DecideKnown(d, state, first + lane, triangle, hn::Load(d, t + lane), tied, tied);
  }
  const std::uint32_t open = pixels & ~ties;
  for (std::uint32_t bits = open; bits != 0; bits &= bits - 1) {
    const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
    decide_pixel(view, state, static_cast<int>(first + i), placed);
  }
  if (open != 0) SetBounds(state, block, open);
}

// Decides pixels of a block that the triangle certainly covers, but at a depth too near to the winner's.
template <class Triangles>
inline void DecideDepths(const TileView& view, const Triangles& triangles, TileState& state, int block,
                         std::uint32_t triangle, std::uint32_t pixels) {
  LearnBlock(view, triangles, state, block, pixels);
  const size_t first = static_cast<size_t>(block) * kBlockPixels;
  const BlockRays rays(state, block);
  const hn::CappedTag<float, 16> d;
  std::uint32_t open = pixels;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    auto certain = hn::FirstN(d, 0);
    const auto depth = DepthsOf(d, rays, state.drawn, triangle, lane, certain);
    DecideKnown(d, state, first + lane, triangle, depth, certain, MaskOfBits(d, pixels >> lane));
    open &= ~(MaskBits(d, certain) << lane);
  }
  if (HWY_UNLIKELY(open != 0)) DecideTies(view, triangles, state, block, triangle, open);
}

// Decides pixels of a block that the triangle may or may not cover.
template <class Triangles>
inline void DecidePixels(const TileView& view, const Triangles& triangles, TileState& state, int block,
                         std::uint32_t triangle, std::uint32_t pixels) {
  LearnBlock(view, triangles, state, block, pixels);
  for (std::uint32_t bits = pixels; bits != 0; bits &= bits - 1) {
    const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
    decide_pixel(view, state, block * kBlockPixels + i, Placed(triangles, state, triangle));
  }
  SetBounds(state, block, pixels);
}

// A triangle's plane at pixels of the tile.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PlaneAt(D d, const TileTriangle& triangle, int plane, V x, V y) {
  return PlaneAt(d, triangle.a[plane], triangle.b[plane], triangle.c[plane], x, y);
}

// The least of its edge functions there: NaN where one is, but then their error is infinite.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V LeastEdge(D d, const TileTriangle& triangle, V x, V y) {
  return hn::Min(hn::Min(PlaneAt(d, triangle, 0, x, y), PlaneAt(d, triangle, 1, x, y)),
                 PlaneAt(d, triangle, 2, x, y));
}

// The plane of 1/t.
HWY_INLINE InversePlane InverseOf(const TileTriangle& triangle) {
  return {triangle.a[3], triangle.b[3], triangle.c[3], triangle.error[3]};
}

// `Counts` is told what is tested: NoTileCounts (pixels/no_tile_counts.h) or raster/tile_counts.h.

// Draws the triangle into a block, which is not whole; with `kFull` it certainly covers every pixel.
template <bool kFull, class Triangles, class Counts>
HWY_INLINE void DrawNearest(const TileView& view, const Triangles& triangles, const TileTriangle& triangle,
                            bool side_open, int block, TileState& state, Counts& counts) {
  counts.block(kFull);
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  std::uint32_t won_bits = 0, depth_open = 0, edge_open = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const size_t offset = static_cast<size_t>(block * kBlockPixels) + lane;
    auto x = hn::Zero(d), y = hn::Zero(d);
    PixelCentres(d, block, lane, x, y);
    const auto inverse = PlaneAt(d, triangle, 3, x, y);
    const auto error = hn::Set(d, triangle.error[3]);
    const auto low = hn::Sub(inverse, error);
    const auto high = hn::Add(inverse, error);
    auto closed = hn::Lt(high, hn::Load(d, state.inverse_low + offset));
    auto covered = hn::Not(closed);
    if constexpr (!kFull) {
      const auto edge = LeastEdge(d, triangle, x, y);
      closed = hn::Or(closed, hn::Lt(edge, hn::Set(d, -triangle.edge_error)));
      covered = hn::And(covered, hn::Gt(edge, hn::Set(d, triangle.edge_error)));
    }
    const auto won = hn::And(covered, hn::Gt(low, hn::Load(d, state.inverse_high + offset)));
    hn::BlendedStore(low, won, d, state.inverse_low + offset);
    hn::BlendedStore(high, won, d, state.inverse_high + offset);
    hn::BlendedStore(hn::Set(du, triangle.place), hn::RebindMask(du, won), du, state.winner + offset);
    won_bits |= MaskBits(d, won) << lane;
    depth_open |= MaskBits(d, hn::AndNot(won, covered)) << lane;
    if constexpr (!kFull) edge_open |= MaskBits(d, hn::Not(hn::Or(closed, covered))) << lane;
  }
  state.settled[block] &= static_cast<std::uint16_t>(~won_bits);
  state.changed |= std::uint64_t{(won_bits | depth_open | edge_open) != 0} << block;
  if (HWY_LIKELY((depth_open | edge_open) == 0)) return;
  if (side_open) {
    edge_open |= depth_open;
    depth_open = 0;
  }
  counts.open_pixels(depth_open | edge_open);
  if (depth_open != 0) DecideDepths(view, triangles, state, block, triangle.place, depth_open);
  if (edge_open != 0) DecidePixels(view, triangles, state, block, triangle.place, edge_open);
}

// The same into a tile whose pixels keep their first triangles: every hit that may be among them is added, at
// its exact depth.
template <bool kFull, class Triangles, class Counts>
inline void DrawEntries(const TileView& view, const Triangles& triangles, const TileTriangle& triangle,
                        bool side_open, int block, LayeredTile& tile, Counts& counts) {
  counts.block(kFull);
  const hn::CappedTag<float, 16> d;
  std::uint32_t covered_bits = 0, open_bits = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const size_t offset = static_cast<size_t>(block * kBlockPixels) + lane;
    auto x = hn::Zero(d), y = hn::Zero(d);
    PixelCentres(d, block, lane, x, y);
    const auto high = hn::Add(PlaneAt(d, triangle, 3, x, y), hn::Set(d, triangle.error[3]));
    auto closed = hn::Lt(high, hn::Load(d, tile.inverse_low + offset));
    auto covered = hn::Not(closed);
    if constexpr (!kFull) {
      const auto edge = LeastEdge(d, triangle, x, y);
      closed = hn::Or(closed, hn::Lt(edge, hn::Set(d, -triangle.edge_error)));
      covered = hn::And(covered, hn::Gt(edge, hn::Set(d, triangle.edge_error)));
    }
    covered_bits |= MaskBits(d, covered) << lane;
    open_bits |= MaskBits(d, hn::Not(hn::Or(closed, covered))) << lane;
  }
  if ((covered_bits | open_bits) == 0) return;
  HWY_ALIGN float t[kBlockPixels];
  std::uint32_t certain = 0;
  if (!side_open && covered_bits != 0)
    certain = BlockDepthsOf(BlockRays(tile, block), tile.drawn, triangle.place, covered_bits, t);
  const std::uint32_t asked = (covered_bits | open_bits) & ~certain;
  counts.open_pixels(asked);
  for (std::uint32_t bits = certain; bits != 0; bits &= bits - 1) {
    const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
    add_entry(tile, block * kBlockPixels + i, t[i], tile.drawn.id[triangle.place]);
  }
  for (std::uint32_t bits = asked; bits != 0; bits &= bits - 1) {
    const int i = static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
    decide_entry(view, tile, block * kBlockPixels + i, Placed(triangles, tile, triangle.place));
  }
  SetBounds(tile, block, certain | asked);
  tile.changed |= std::uint64_t{1} << block;
}

template <bool kFull, class Triangles, class State, class Counts>
HWY_INLINE void DrawBlock(const TileView& view, const Triangles& triangles, const TileTriangle& triangle,
                          bool side_open, int block, State& state, Counts& counts) {
  if constexpr (State::kLayered) {
    DrawEntries<kFull>(view, triangles, triangle, side_open, block, state, counts);
  } else {
    PartIfWhole(state, block);
    DrawNearest<kFull>(view, triangles, triangle, side_open, block, state, counts);
  }
}

// The blocks of a tile that hold pixels of the triangle's box, one bit each.
HWY_INLINE std::uint64_t BoxBlocks(const TileTriangle& triangle) {
  const std::uint64_t columns = (2u << triangle.x1 / kBlockPx) - (1u << triangle.x0 / kBlockPx);
  const std::uint64_t rows = (~std::uint64_t{0} >> (8 * (7 - triangle.y1 / kBlockPx))) &
                             (~std::uint64_t{0} << (8 * (triangle.y0 / kBlockPx)));
  return columns * 0x0101010101010101u & rows;
}

// Gives the triangle the blocks whose bit is set: they are whole.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void WinBlocks(D d, const TileTriangle& triangle, size_t first, std::uint32_t won, V low, V high,
                          TileState& state) {
  const hn::RebindToUnsigned<decltype(d)> du;
  const auto mask = MaskOfBits(d, won);
  hn::BlendedStore(low, mask, d, state.block_low + first);
  hn::BlendedStore(high, mask, d, state.block_high + first);
  hn::BlendedStore(hn::Set(du, triangle.place), hn::RebindMask(du, mask), du, state.block_winner + first);
  state.drawn.inverse[triangle.place] = InverseOf(triangle);
  const std::uint64_t blocks = std::uint64_t{won} << first;
  state.whole |= blocks;
  state.changed |= blocks;
}

// Draws a triangle whose box has many blocks: those that it meets, a vector at a time.
template <class Triangles, class State, class Counts>
HWY_NOINLINE inline void DrawBlocks(const TileView& view, const Triangles& triangles,
                                    const TileTriangle& triangle, bool side_open, State& state,
                                    Counts& counts) {
  const hn::CappedTag<float, 16> d;
  const std::uint64_t box = BoxBlocks(triangle);
  const size_t lanes = hn::Lanes(d);
  const size_t begin = triangle.y0 / kBlockPx * size_t{kTileBlocks} / lanes * lanes;
  const size_t end = (triangle.y1 / kBlockPx + 1) * size_t{kTileBlocks};
  HWY_ALIGN float grow[4];
  Grow(triangle, 1.5f, grow);
  for (size_t first = begin; first < end; first += lanes) {
    auto open = hn::FirstN(d, 0), full = hn::FirstN(d, 0);
    auto low = hn::Zero(d), high = hn::Zero(d);
    TestBlocks(d, triangle, grow, first, state.block_low, open, full, low, high);
    counts.block_tests(lanes);
    const std::uint32_t full_bits = MaskBits(d, full);
    std::uint32_t bits = MaskBits(d, open) & static_cast<std::uint32_t>(box >> first);
    if constexpr (!State::kLayered) {
      // In front of all that a whole block sees, it takes the place of that.
      const std::uint32_t won =
          bits & full_bits & MaskBits(d, hn::Gt(low, hn::Load(d, state.block_high + first)));
      if (won != 0 && !side_open) {
        WinBlocks(d, triangle, first, won, low, high, state);
        counts.won_blocks(won);
        bits &= ~won;
      }
    }
    for (; bits != 0; bits &= bits - 1) {
      const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
      const int block = static_cast<int>(first + i);
      if ((full_bits >> i & 1) != 0) {
        DrawBlock<true>(view, triangles, triangle, side_open, block, state, counts);
      } else {
        DrawBlock<false>(view, triangles, triangle, side_open, block, state, counts);
      }
    }
  }
}

// Draws a triangle whose box has few blocks.
template <class Triangles, class State, class Counts>
HWY_INLINE void DrawSmall(const TileView& view, const Triangles& triangles, const TileTriangle& triangle,
                          State& state, Counts& counts) {
  const int x1 = triangle.x1 / kBlockPx, y1 = triangle.y1 / kBlockPx;
  for (int y = triangle.y0 / kBlockPx; y <= y1; ++y) {
    for (int x = triangle.x0 / kBlockPx; x <= x1; ++x)
      DrawBlock<false>(view, triangles, triangle, false, y * kTileBlocks + x, state, counts);
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
