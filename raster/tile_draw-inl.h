// Draws the triangles of a tile's list. It is the descent of a quadtree over the screen, from coarse to fine
// (Warnock 1969, "A hidden surface algorithm for computer generated halftone pictures"), with several of its
// levels a step: frame, tile of 32 x 32, then block of 4 x 4 and pixel (pixels/block_draw-inl.h). Included
// once per Highway target.

#if defined(PLUMB_RASTER_TILE_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_TILE_DRAW_INL_H_
#undef PLUMB_RASTER_TILE_DRAW_INL_H_
#else
#define PLUMB_RASTER_TILE_DRAW_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <span>

#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "pixels/block_draw-inl.h"
#include "pixels/no_tile_counts.h"
#include "pixels/tile_planes-inl.h"
#include "pixels/tile_state-inl.h"
#include "raster/kernels.h"
#include "raster/tile_counts.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class Counts>
HWY_INLINE void DrawWide(const TileView& view, const MeshTriangles& mesh, const ScreenTriangle& triangle,
                         TileState& state, Counts& counts) {
  if (triangle.x0 >= view.x + kTilePx || triangle.x1 < view.x || triangle.y0 >= view.y + kTilePx ||
      triangle.y1 < view.y)
    return;
  TileTriangle placed;
  PlaceTriangle(triangle, view.x, view.y, placed);
  if (!OutsideTile(placed)) DrawBlocks(view, mesh, placed, triangle.side_open, state, counts);
  if (HWY_LIKELY(!triangle.side_open)) return;
  TurnEdges(placed);
  DrawBlocks(view, mesh, placed, true, state, counts);
}

template <class Counts>
HWY_INLINE void DrawEntries(const TileView& view, const MeshTriangles& mesh, const BinnedTriangles& triangles,
                            std::span<const BinEntry> entries, Frame& frame, Counts& counts) {
  constexpr size_t kAhead = 8;
  const auto prefetch = [&](const BinEntry& entry) HWY_ATTR {
    const auto* next = entry.placed() ? reinterpret_cast<const char*>(triangles.placed + entry.index())
                                      : reinterpret_cast<const char*>(triangles.wide + entry.index());
    hwy::Prefetch(next);
    hwy::Prefetch(next + 64);
  };
  for (size_t i = 0; i < std::min(kAhead, entries.size()); ++i) prefetch(entries[i]);
  TileState state;
  LoadTile(view, frame, state);
  for (size_t i = 0; i < entries.size(); ++i) {
    if (i + kAhead < entries.size()) prefetch(entries[i + kAhead]);
    const BinEntry entry = entries[i];
    if (i % 8 == 0) UpdateLows(state);
    const bool hidden = entry.nearest < state.tile_low;  // in all of the tile
    counts.tile(hidden);
    if (hidden) continue;
    if (!entry.placed()) {
      DrawWide(view, mesh, triangles.wide[entry.index()], state, counts);
      continue;
    }
    const TileTriangle& triangle = triangles.placed[entry.index()];
    if (triangle.x1 / kBlockPx - triangle.x0 / kBlockPx < 2 &&
        triangle.y1 / kBlockPx - triangle.y0 / kBlockPx < 2) {
      DrawSmall(view, mesh, triangle, state, counts);
    } else {
      DrawBlocks(view, mesh, triangle, false, state, counts);
    }
  }
  StoreTile(view, mesh, state, frame);
}

inline void DrawTile(const TileView& view, const MeshTriangles& mesh, const BinnedTriangles& triangles,
                     std::span<const BinEntry> entries, Frame& frame) {
  NoTileCounts counts;
  DrawEntries(view, mesh, triangles, entries, frame, counts);
}

// The same, counted: out of line, so that it costs the other nothing.
HWY_NOINLINE inline void CountTile(const TileView& view, const MeshTriangles& mesh,
                                   const BinnedTriangles& triangles, std::span<const BinEntry> entries,
                                   Frame& frame, RasterCounts& counts) {
  TileCounts counter{counts};
  DrawEntries(view, mesh, triangles, entries, frame, counter);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
