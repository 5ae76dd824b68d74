// A tile's start, from nothing or from the frame, and its end, to the frame. Included once per Highway
// target.

#if defined(PLUMB_PIXELS_TILE_FRAME_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_TILE_FRAME_INL_H_
#undef PLUMB_PIXELS_TILE_FRAME_INL_H_
#else
#define PLUMB_PIXELS_TILE_FRAME_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iterator>

#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "pixels/pixel_direction-inl.h"
#include "pixels/tile_bounds-inl.h"
#include "pixels/tile_settle-inl.h"
#include "pixels/tile_state.h"
#include "plumb/frame.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The pixel of the frame that a row of the tile begins with.
HWY_INLINE size_t RowOf(const TileView& view, int y) {
  return static_cast<size_t>(view.y + y) * static_cast<size_t>(view.camera.width) +
         static_cast<size_t>(view.x);
}

// Calls copy(pixel of the frame, offset in the tile, pixels) for each run of up to four pixels that the tile
// has in the frame, in its rows from the first to before the last.
template <class Copy>
HWY_INLINE void ForEachRun(const TileView& view, int first_row, int last_row, const Copy& copy) {
  const int columns = std::min(kTilePx, view.camera.width - view.x);
  const int rows = std::min(last_row, view.camera.height - view.y);
  for (int y = first_row; y < rows; ++y) {
    const size_t row = RowOf(view, y);
    for (int x = 0; x < columns; x += kBlockPx)
      copy(row + static_cast<size_t>(x), tile_offset(x, y), std::min(kBlockPx, columns - x));
  }
}

HWY_INLINE void CopyRun(void* to, const void* from, int pixels) {
  if (HWY_LIKELY(pixels == kBlockPx)) {
    std::memcpy(to, from, 4 * kBlockPx);  // a size that the compiler knows
  } else {
    std::memcpy(to, from, 4 * static_cast<size_t>(pixels));
  }
}

// What the directions of a tile's pixels are made of.
HWY_INLINE void StartDirections(const TileView& view, TileState& state) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const Camera& camera = view.camera;
  for (int block = 0; block < kTileBlocks; ++block) {
    // From the block's centre, 1.5 pixels in, and the pixel's half.
    const auto base_x = hn::Set(d, view.x + block * kBlockPx + 2.0);
    const auto base_y = hn::Set(d, view.y + block * kBlockPx + 2.0);
    for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
      const auto x = hn::Add(base_x, hn::PromoteTo(d, hn::Load(df, kCentres.pixel_x + lane)));
      const auto y = hn::Add(base_y, hn::PromoteTo(d, hn::Load(df, kCentres.pixel_y + lane)));
      const size_t to = static_cast<size_t>(block) * kBlockPixels + lane;
      for (int axis = 0; axis < 3; ++axis) {
        hn::Store(DirectionOfColumn(d, x, camera.corner[axis], camera.du[axis]), d,
                  state.direction_x[axis] + to);
        hn::Store(DirectionOfRow(d, y, camera.dv[axis]), d, state.direction_y[axis] + to);
      }
    }
  }
}

// Hides pixels outside the frame, whose t is -inf, from all.
HWY_INLINE void HideOutside(TileState& state) {
  const hn::CappedTag<float, 16> d;
  const auto infinity = hn::Set(d, kFloatInfinity);
  for (size_t offset = 0; offset < kTilePixels; offset += hn::Lanes(d)) {
    const auto outside = hn::Eq(hn::Load(d, state.t + offset), hn::Neg(infinity));
    hn::BlendedStore(infinity, outside, d, state.inverse_low + offset);
    hn::BlendedStore(infinity, outside, d, state.inverse_high + offset);
  }
}

// Parts every block.
inline void PartBlocks(TileState& state) {
  for (int block = 0; block < kTileBlocks * kTileBlocks; ++block) PartIfWhole(state, block);
}

// Starts a tile that sees nothing yet.
inline void StartTile(const TileView& view, TileState& state) {
  StartDirections(view, state);
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (size_t block = 0; block < kTileBlocks * kTileBlocks; block += hn::Lanes(d)) {
    hn::Store(hn::Set(d, -kFloatInfinity), d, state.block_low + block);
    hn::Store(hn::Set(d, TileState::kLeastInverse), d, state.block_high + block);
    hn::Store(hn::Set(du, TileState::kEarlier), du, state.block_winner + block);
  }
  state.whole = ~std::uint64_t{0};
  state.changed = 0;
  state.tile_low = -kFloatInfinity;
  state.drawn.count = 0;
  const int columns = view.camera.width - view.x, rows = view.camera.height - view.y;
  if (columns >= kTilePx && rows >= kTilePx) return;
  PartBlocks(state);
  for (int offset = 0; offset < kTilePixels; ++offset) {
    if (tile_x(offset) < columns && tile_y(offset) < rows) continue;
    state.t[offset] = -kFloatInfinity;
    state.inverse_low[offset] = state.inverse_high[offset] = kFloatInfinity;  // hidden from all
  }
  state.changed = ~std::uint64_t{0};
  UpdateLows(state);
}

// Whether the frame's pixels, all of the tile's, see nothing.
HWY_INLINE bool SeesNothing(const TileView& view, const Frame& frame) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const size_t lanes = hn::Lanes(d);
  for (int y = 0; y < kTilePx; ++y) {
    const size_t row = RowOf(view, y);
    auto some = hn::FirstN(d, 0);
    for (size_t x = 0; x < static_cast<size_t>(kTilePx); x += lanes) {
      const auto depth = hn::LoadU(d, frame.depth.data() + row + x);
      const auto id = hn::LoadU(du, frame.id.data() + row + x);
      some = hn::Or(some, hn::Or(hn::Ne(depth, hn::Set(d, kFloatInfinity)),
                                 hn::RebindMask(d, hn::Ne(id, hn::Set(du, kNone)))));
    }
    if (!hn::AllFalse(d, some)) return false;
  }
  return true;
}

// Starts a tile from the frame's pixels.
inline void LoadTile(const TileView& view, const Frame& frame, TileState& state) {
  const bool whole = view.x + kTilePx <= view.camera.width && view.y + kTilePx <= view.camera.height;
  if (whole && SeesNothing(view, frame)) {
    StartTile(view, state);
    return;
  }
  StartDirections(view, state);
  if (!whole) {
    std::fill(std::begin(state.t), std::end(state.t), -kFloatInfinity);
    std::fill(std::begin(state.id), std::end(state.id), 0u);
  }
  ForEachRun(view, 0, kTilePx, [&](size_t pixel, int offset, int pixels) HWY_ATTR {
    CopyRun(state.t + offset, frame.depth.data() + pixel, pixels);
    CopyRun(state.id + offset, frame.id.data() + pixel, pixels);
  });
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (size_t offset = 0; offset < kTilePixels; offset += hn::Lanes(d)) {
    const auto t = hn::Load(d, state.t + offset);
    auto low = hn::Zero(d);
    auto high = hn::Zero(d);
    BoundsOf(d, t, low, high);
    // Outside the frame: hidden from all.
    const auto none = hn::Eq(t, hn::Set(d, -kFloatInfinity));
    low = hn::IfThenElse(none, hn::Set(d, kFloatInfinity), low);
    hn::Store(low, d, state.inverse_low + offset);
    hn::Store(high, d, state.inverse_high + offset);
    hn::Store(hn::Set(du, TileState::kEarlier), du, state.winner + offset);
  }
  std::fill(std::begin(state.settled), std::end(state.settled), std::uint16_t{0xffff});
  std::fill(std::begin(state.block_high), std::end(state.block_high), kFloatInfinity);
  state.whole = 0;
  state.changed = ~std::uint64_t{0};
  state.drawn.count = 0;
  UpdateLows(state);
}

// Gives the frame what a tile sees that nothing was drawn into.
inline void ClearTile(const TileView& view, Frame& frame) {
  const auto columns = static_cast<size_t>(std::min(kTilePx, view.camera.width - view.x));
  const int rows = std::min(kTilePx, view.camera.height - view.y);
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (int y = 0; y < rows; ++y) {
    float* const depth = frame.depth.data() + RowOf(view, y);
    std::uint32_t* const id = frame.id.data() + RowOf(view, y);
    size_t x = 0;
    for (; x + hn::Lanes(d) <= columns; x += hn::Lanes(d)) {
      hn::StoreU(hn::Set(d, kFloatInfinity), d, depth + x);
      hn::StoreU(hn::Set(du, kNone), du, id + x);
    }
    std::fill(depth + x, depth + columns, kFloatInfinity);
    std::fill(id + x, id + columns, kNone);
  }
}

// How many pixels of a row are stored at once: a vector's, or where its size is not known the four that a
// block has side by side.
inline constexpr size_t kStoredAcross = HWY_HAVE_SCALABLE ? kBlockPx : 16;

// A vector of pixels side by side, four of each block.
template <class D>
HWY_INLINE hn::Vec<D> LoadAcross(D d, const hn::TFromD<D>* blocks) {
#if HWY_TARGET != HWY_SCALAR
  if constexpr (hn::MaxLanes(d) > kBlockPx) {
    const hn::Half<D> half;
    const size_t next = hn::Lanes(half) / kBlockPx * kBlockPixels;
    return hn::Combine(d, LoadAcross(half, blocks + next), LoadAcross(half, blocks));
  }
#endif
  return hn::Load(d, blocks);
}

// Gives the frame a row of blocks' pixels, all of which it has; whole vectors are stored several times as
// fast as the four pixels that a block has side by side.
template <class T>
HWY_INLINE void StoreBlocks(const T* blocks, const TileView& view, int row, T* frame) {
  const hn::CappedTag<T, kStoredAcross> d;
  for (int y = 0; y < kBlockPx; ++y) {
    T* const to = frame + RowOf(view, row * kBlockPx + y);
    const T* const from = blocks + y * kBlockPx;
    for (size_t x = 0; x < kTilePx; x += hn::Lanes(d))
      hn::StoreU(LoadAcross(d, from + x / kBlockPx * kBlockPixels + x % kBlockPx), d, to + x);
  }
}

// Fetches the lines of a frame that a row of the tile's blocks is stored to.
HWY_INLINE void FetchRow(const TileView& view, const Frame& frame, int row) {
  const int rows = std::min((row + 1) * kBlockPx, view.camera.height - view.y);
  const size_t last = static_cast<size_t>(std::min(kTilePx, view.camera.width - view.x)) - 1;
  for (int y = row * kBlockPx; y < rows; ++y) {
    const size_t first = RowOf(view, y);
    for (const size_t pixel : {first, first + last / 2, first + last}) {
      hwy::Prefetch(frame.depth.data() + pixel);
      hwy::Prefetch(frame.id.data() + pixel);
    }
  }
}

// Gives the frame what the tile won.
template <class Triangles>
inline void StoreTile(const TileView& view, const Triangles& triangles, TileState& state, Frame& frame) {
  const bool whole = view.x + kTilePx <= view.camera.width;
  // What the tile overwrites has not been read.
  FetchRow(view, frame, 0);
  FetchRow(view, frame, 1);
  for (int row = 0; row < kTileBlocks; ++row) {
    if (row + 2 < kTileBlocks) FetchRow(view, frame, row + 2);
    SettleRow(view, triangles, state, row);
    const int end = (row + 1) * kBlockPx;
    if (HWY_LIKELY(whole && view.y + end <= view.camera.height)) {
      const int first = row * kTileBlocks * kBlockPixels;
      StoreBlocks(state.t + first, view, row, frame.depth.data());
      StoreBlocks(state.id + first, view, row, frame.id.data());
      continue;
    }
    ForEachRun(view, end - kBlockPx, end, [&](size_t pixel, int offset, int pixels) HWY_ATTR {
      CopyRun(frame.depth.data() + pixel, state.t + offset, pixels);
      CopyRun(frame.id.data() + pixel, state.id + offset, pixels);
    });
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
