// Draws a tile's wide triangles, which are set up already. Included once per Highway target.

#if defined(PLUMB_RASTER_WIDE_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_WIDE_DRAW_INL_H_
#undef PLUMB_RASTER_WIDE_DRAW_INL_H_
#else
#define PLUMB_RASTER_WIDE_DRAW_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/mask_bits-inl.h"
#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "pixels/block_draw-inl.h"
#include "pixels/tile_planes-inl.h"
#include "pixels/tile_settle-inl.h"
#include "raster/kernels.h"
#include "raster/square_lists.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Adds a triangle to the tile's drawn ones; returns its place. There must be room.
HWY_INLINE std::uint32_t AddWide(const MeshTriangles& mesh, const ScreenTriangle& triangle,
                                 TileState& state) {
  DrawnTriangles& to = state.drawn;
  const size_t place = to.count++;
  for (int k = 0; k < 4; ++k) to.normal[place][k] = triangle.plane[k];
  for (int k = 0; k < 2; ++k) to.bounds[place][k] = triangle.plane[4 + k];
  to.index[place] = triangle.index;
  to.id[place] = mesh.id(triangle.index);
  return static_cast<std::uint32_t>(place);
}

// Draws a triangle whose box may have pixels of the tile.
template <class State, class Counts>
HWY_INLINE void DrawWide(const TileView& view, const MeshTriangles& mesh, const ScreenTriangle& triangle,
                         State& state, Counts& counts) {
  if (triangle.x0 >= view.x + kTilePx || triangle.x1 < view.x || triangle.y0 >= view.y + kTilePx ||
      triangle.y1 < view.y)
    return;
  TileTriangle placed;
  PlaceTriangle(triangle, view.x, view.y, placed);
  MakeRoom(view, mesh, state, 1);
  placed.place = AddWide(mesh, triangle, state);
  DrawBlocks(view, mesh, placed, triangle.side_open, state, counts);
  if (HWY_LIKELY(!triangle.side_open)) return;
  TurnEdges(placed);
  DrawBlocks(view, mesh, placed, true, state, counts);
}

HWY_INLINE void FetchWide(const WideEntry& entry) {
  const auto* const bytes = reinterpret_cast<const char*>(entry.triangle);
  for (size_t offset = 0; offset < sizeof(ScreenTriangle); offset += 64) hwy::Prefetch(bytes + offset);
}

// Draws the triangles of a list that is roughly in order.
template <class State, class Counts>
HWY_INLINE void DrawWideList(const TileJob& job, const MeshTriangles& mesh, std::span<const WideEntry> list,
                             State& state, Counts& counts) {
  constexpr size_t kAhead = 8;
  for (size_t i = 0; i < std::min(kAhead, list.size()); ++i) FetchWide(list[i]);
  for (size_t i = 0; i < list.size(); ++i) {
    if (i + kAhead < list.size()) FetchWide(list[i + kAhead]);
    if (i % 8 == 0) UpdateLows(state);
    const bool hidden = list[i].nearest < state.tile_low;  // in all of the tile
    counts.tile(hidden);
    if (hidden) continue;
    const ScreenTriangle& triangle = *list[i].triangle;
    if (HWY_UNLIKELY(triangle.side_open) ||
        !OutsideTile(triangle, job.view.x, job.view.y, std::max(state.tile_low, 0.0f)))
      DrawWide(job.view, mesh, triangle, state, counts);
  }
}

// Those of a group that the tile may see, a bit each; `low` >= 0 is a 1/t below which all is hidden.
HWY_INLINE std::uint32_t SeenOfGroup(const WideGroup& group, float x, float y, float low) {
  const hn::CappedTag<float, WideGroup::kSize> d;
  std::uint32_t seen = 0;
  for (size_t lane = 0; lane < WideGroup::kSize; lane += hn::Lanes(d)) {
    const auto below = [&](int k, float least) HWY_ATTR {
      const auto row =
          hn::MulAdd(hn::Load(d, group.b[k] + lane), hn::Set(d, y), hn::Load(d, group.c[k] + lane));
      return hn::Lt(hn::MulAdd(hn::Load(d, group.a[k] + lane), hn::Set(d, x), row), hn::Set(d, least));
    };
    const auto outside =
        hn::Or(hn::Or(below(0, 0.0f), below(1, 0.0f)), hn::Or(below(2, 0.0f), below(3, low)));
    seen |= MaskBits(d, hn::Not(outside)) << lane;
  }
  return seen;
}

// Draws the triangles of a square's list, up to the first that is hidden: so are all that follow.
template <class State, class Counts>
HWY_INLINE void DrawSorted(const TileJob& job, const MeshTriangles& mesh, const SortedList& list,
                           State& state, Counts& counts) {
  const size_t count = list.entries.size();
  for (size_t first = 0; first < count; first += WideGroup::kSize) {
    UpdateLows(state);
    const size_t end = std::min(first + WideGroup::kSize, count);
    if (list.entries[first].nearest < state.tile_low) {
      for (size_t i = first; i < count; ++i) counts.tile(true);
      return;
    }
    for (size_t i = first; i < end; ++i) counts.tile(false);
    const std::uint32_t seen =
        SeenOfGroup(list.groups[first / WideGroup::kSize], list.x, list.y, std::max(state.tile_low, 0.0f));
    for (std::uint32_t bits = seen; bits != 0; bits &= bits - 1)
      FetchWide(list.entries[first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)]);
    for (std::uint32_t bits = seen; bits != 0; bits &= bits - 1) {
      const WideEntry& entry = list.entries[first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits)];
      DrawWide(job.view, mesh, *entry.triangle, state, counts);
    }
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
