// Draws candidates into a tile: sets a vector of them up, then draws one after the other. Included once per
// Highway target.

#if defined(PLUMB_PIXELS_CANDIDATE_DRAW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_CANDIDATE_DRAW_INL_H_
#undef PLUMB_PIXELS_CANDIDATE_DRAW_INL_H_
#else
#define PLUMB_PIXELS_CANDIDATE_DRAW_INL_H_
#endif

#include <algorithm>
#include <cstdint>

#include "hwy/highway.h"
#include "pixels/block_draw-inl.h"
#include "pixels/screen_bounds-inl.h"
#include "pixels/triangle_setup-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Draws a triangle placed about the tile. With `side_open` it is drawn as seen from either side, and turned.
template <class Triangles, class State, class Counts>
HWY_INLINE void DrawPlaced(const TileView& view, const Triangles& triangles, TileTriangle& triangle,
                           bool side_open, State& state, Counts& counts) {
  if (HWY_UNLIKELY(side_open)) {
    DrawBlocks(view, triangles, triangle, true, state, counts);
    TurnEdges(triangle);
    DrawBlocks(view, triangles, triangle, true, state, counts);
  } else if (triangle.x1 / kBlockPx - triangle.x0 / kBlockPx < 2 &&
             triangle.y1 / kBlockPx - triangle.y0 / kBlockPx < 2) {
    DrawSmall(view, triangles, triangle, state, counts);
  } else {
    DrawBlocks(view, triangles, triangle, false, state, counts);
  }
}

// Adds a vector of triangles to the tile's drawn ones; returns the place of the first. Those that are not
// drawn are added too: nobody asks for them, and whole vectors are stored fast.
template <class Triangles>
HWY_INLINE std::uint32_t AddDrawn(const TileView& view, const Triangles& triangles,
                                  const SetupCandidates& from, size_t first, size_t count,
                                  const SetupLanes& lanes, TileState& state) {
  const SetupTag d;
  MakeRoom(view, triangles, state, hn::Lanes(d));
  DrawnTriangles& to = state.drawn;
  const size_t place = to.count;
  const auto plane = [&](int k) HWY_ATTR { return hn::Load(d, lanes.plane[k]); };
  hn::StoreInterleaved4(plane(0), plane(1), plane(2), plane(3), d, to.normal[place]);
  hn::StoreInterleaved2(plane(4), plane(5), d, to.bounds[place]);
  for (size_t i = 0; i < count; ++i) {
    to.index[place + i] = from.index[first + i];
    to.id[place + i] = triangles.id(from.index[first + i]);
  }
  to.count += count;
  return static_cast<std::uint32_t>(place);
}

// Draws a vector's worth of candidates from `first` on, or the `count` that are left. Their boxes lie in the
// tile.
template <class Triangles, class State, class Counts>
HWY_INLINE void DrawCandidates(const Projection& projection, const TileView& view, const Triangles& triangles,
                               const SetupCandidates& candidates, size_t first, size_t count, State& state,
                               Counts& counts) {
  const SetupTag d;
  SetupLanes lanes;
  std::uint32_t side_open = 0, uncovered = 0;
  SetUpLanes(projection, candidates, first, lanes, side_open, uncovered);
  const std::uint32_t drawn = ((1u << count) - 1) & ~uncovered;
  if (drawn == 0) return;
  PlaceLanes(hn::Set(d, view.x), hn::Set(d, view.y), lanes);
  const std::uint32_t place = AddDrawn(view, triangles, candidates, first, count, lanes, state);
  // All are stored before any is drawn: what has just been stored by parts is slow to load as a whole.
  TileTriangle placed[8];
  for (std::uint32_t bits = drawn; bits != 0; bits &= bits - 1) {
    const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
    StorePlaced(lanes, i, candidates, first + i, placed[i]);
    placed[i].place = place + static_cast<std::uint32_t>(i);
  }
  for (std::uint32_t bits = drawn; bits != 0; bits &= bits - 1) {
    const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
    DrawPlaced(view, triangles, placed[i], (side_open >> i & 1) != 0, state, counts);
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
