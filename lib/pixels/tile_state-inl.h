// A tile's pixels by the vector: taking them from the frame, their bounds, their exact answers, and giving
// them back. Included once per Highway target.

#if defined(PLUMB_PIXELS_TILE_STATE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_TILE_STATE_INL_H_
#undef PLUMB_PIXELS_TILE_STATE_INL_H_
#else
#define PLUMB_PIXELS_TILE_STATE_INL_H_
#endif

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>

#include "base/mask_bits-inl.h"
#include "exact/depth-inl.h"
#include "hwy/highway.h"
#include "pixels/pixel_direction-inl.h"
#include "pixels/tile_planes-inl.h"
#include "pixels/tile_state.h"
#include "plumb/frame.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

constexpr float kFloatInfinity = std::numeric_limits<float>::infinity();

// The bounds of 1/t that pixels of known t have.
//
// With u = 2^-24: t is within u of the exact one, 1/t is rounded, and so is the product: 3 u. A triangle
// whose own bounds (pixels/tile_planes-inl.h: 1.1 u to spare) lie beyond these, 4 u away, has another
// exact t by more than 2 u of it, so it rounds beyond t. Where 1/t may leave the range in which that holds
// nothing is certain.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void BoundsOf(D d, V t, V& low, V& high) {
  const V infinity = hn::Set(d, kFloatInfinity);
  const V least = hn::Set(d, TileState::kLeastInverse);
  const V inverse = hn::Div(hn::Set(d, 1.0f), t);
  const auto usable = hn::And(hn::Gt(inverse, least), hn::Lt(inverse, hn::Set(d, kGreatestInverse)));
  low = hn::IfThenElse(usable, hn::Mul(inverse, hn::Set(d, 1.0f - 0x1p-22f)), hn::Neg(infinity));
  const V beyond = hn::IfThenElse(hn::Eq(t, infinity), least, infinity);
  high = hn::IfThenElse(usable, hn::Mul(inverse, hn::Set(d, 1.0f + 0x1p-22f)), beyond);
}

// Takes the bounds of a block's pixels from t where a bit is set; their winners must be known.
HWY_INLINE void SetBounds(TileState& state, int block, std::uint32_t pixels) {
  const hn::CappedTag<float, 16> d;
  for (size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
    const size_t offset = static_cast<size_t>(block * kBlockPixels) + lane;
    const auto mask = MaskOfBits(d, pixels >> lane);
    auto low = hn::Zero(d);
    auto high = hn::Zero(d);
    BoundsOf(d, hn::Load(d, state.t + offset), low, high);
    hn::BlendedStore(low, mask, d, state.inverse_low + offset);
    hn::BlendedStore(high, mask, d, state.inverse_high + offset);
  }
}

// Takes a block's least bound anew.
HWY_INLINE void UpdateBlock(TileState& state, int block) {
  const hn::CappedTag<float, 16> d;
  const float* low = state.inverse_low + block * kBlockPixels;
  auto least = hn::Load(d, low);
  for (size_t lane = hn::Lanes(d); lane < 16; lane += hn::Lanes(d))
    least = hn::Min(least, hn::Load(d, low + lane));
  state.block_low[block] = hn::GetLane(hn::MinOfLanes(d, least));
}

// Takes the changed blocks' least bounds anew, and the tile's.
HWY_INLINE void UpdateLows(TileState& state) {
  if (state.changed == 0) return;
  for (; state.changed != 0; state.changed &= state.changed - 1)
    UpdateBlock(state, static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(state.changed)));
  const hn::CappedTag<float, 16> d;
  auto least = hn::Load(d, state.block_low);
  for (size_t i = hn::Lanes(d); i < kTileBlocks * kTileBlocks; i += hn::Lanes(d))
    least = hn::Min(least, hn::Load(d, state.block_low + i));
  state.tile_low = hn::GetLane(hn::MinOfLanes(d, least));
}

// Calls copy(pixel of the frame, offset in the tile, pixels) for each run of up to four pixels that the tile
// has in the frame.
template <class Copy>
HWY_INLINE void ForEachRun(const TileView& view, const Copy& copy) {
  const int columns = std::min(kTilePx, view.camera.width - view.x);
  const int rows = std::min(kTilePx, view.camera.height - view.y);
  for (int y = 0; y < rows; ++y) {
    const size_t row = static_cast<size_t>(view.y + y) * static_cast<size_t>(view.camera.width) +
                       static_cast<size_t>(view.x);
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

// Starts a tile that sees nothing yet.
inline void StartTile(const TileView& view, TileState& state) {
  StartDirections(view, state);
  const int columns = view.camera.width - view.x, rows = view.camera.height - view.y;
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (size_t offset = 0; offset < kTilePixels; offset += hn::Lanes(d)) {
    hn::Store(hn::Set(d, -kFloatInfinity), d, state.inverse_low + offset);
    hn::Store(hn::Set(d, TileState::kLeastInverse), d, state.inverse_high + offset);
    hn::Store(hn::Set(d, kFloatInfinity), d, state.t + offset);
    hn::Store(hn::Set(du, kNone), du, state.id + offset);
    hn::Store(hn::Set(du, TileState::kEarlier), du, state.winner + offset);
    hn::Store(hn::Set(du, TileState::kEarlier), du, state.known + offset);
  }
  if (columns < kTilePx || rows < kTilePx) {
    for (int offset = 0; offset < kTilePixels; ++offset) {
      if (tile_x(offset) < columns && tile_y(offset) < rows) continue;
      state.t[offset] = -kFloatInfinity;
      state.inverse_low[offset] = state.inverse_high[offset] = kFloatInfinity;  // hidden from all
    }
  }
  state.changed = ~std::uint64_t{0};
  state.drawn.count = 0;
  UpdateLows(state);
}

// Whether the frame's pixels, all of the tile's, see nothing.
HWY_INLINE bool SeesNothing(const TileView& view, const Frame& frame) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const size_t lanes = hn::Lanes(d);
  for (int y = 0; y < kTilePx; ++y) {
    const size_t row = static_cast<size_t>(view.y + y) * static_cast<size_t>(view.camera.width) +
                       static_cast<size_t>(view.x);
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
  ForEachRun(view, [&](size_t pixel, int offset, int pixels) HWY_ATTR {
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
    hn::Store(hn::Set(du, TileState::kEarlier), du, state.known + offset);
  }
  state.changed = ~std::uint64_t{0};
  state.drawn.count = 0;
  UpdateLows(state);
}

// What a tile is drawn from, `Triangles`, numbers its triangles from 0 to below TileState::kEarlier:
//     corners(index)    their vertices, as a Triangle
//     id(index)         their ids

template <class Triangles>
HWY_INLINE PlacedTriangle Placed(const Triangles& triangles, const TileState& state, std::uint32_t place) {
  return {place, state.drawn.id[place], triangles.corners(state.drawn.index[place])};
}

// The directions of a block's pixels, component by component.
struct BlockRays {
  alignas(64) double direction[3][kBlockPixels];

  HWY_INLINE BlockRays(const TileState& state, int block) {
    const hn::CappedTag<double, 8> d;
    const double* const column = state.direction_x[0] + block % kTileBlocks * kBlockPixels;
    const double* const row = state.direction_y[0] + block / kTileBlocks * kBlockPixels;
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t offset = axis * kTileBlocks * kBlockPixels;
      for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
        const auto of = Direction(d, hn::Load(d, column + offset + lane), hn::Load(d, row + offset + lane));
        hn::Store(of, d, this->direction[axis] + lane);
      }
    }
  }
};

// The depths that a block's pixels see, `plane(d, k, lane)` being DrawnTriangles' planes of those from `lane`
// on. Where a bit of `wanted` is set it is stored to `t`; returns those of them that are certain.
template <class Plane>
HWY_INLINE std::uint32_t BlockDepths(const BlockRays& rays, const Plane& plane, std::uint32_t wanted,
                                     float* t) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  std::uint32_t bits = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const auto ray = [&](int axis) HWY_ATTR { return hn::Load(d, rays.direction[axis] + lane); };
    const auto of = [&](int k) HWY_ATTR { return plane(d, k, lane); };
    auto depth = hn::Zero(df);
    auto certain = hn::FirstN(df, 0);
    PlaneDepths(d, ray(0), ray(1), ray(2), of(0), of(1), of(2), of(3), of(4), of(5), depth, certain);
    hn::BlendedStore(depth, MaskOfBits(df, wanted >> lane), df, t + lane);
    bits |= MaskBits(df, certain) << lane;
  }
  return bits & wanted;
}

// Of one triangle.
HWY_INLINE std::uint32_t BlockDepthsOf(const BlockRays& rays, const DrawnTriangles& drawn,
                                       std::uint32_t place, std::uint32_t wanted, float* t) {
  return BlockDepths(
      rays, [&](auto d, int k, size_t) HWY_ATTR { return hn::Set(d, drawn.plane[k][place]); }, wanted, t);
}

// Of each pixel's own triangle, whose places are given.
HWY_INLINE std::uint32_t BlockDepthsOfEach(const BlockRays& rays, const DrawnTriangles& drawn,
                                           const std::uint32_t* place, std::uint32_t wanted, float* t) {
  return BlockDepths(
      rays,
      [&](auto d, int k, size_t lane) HWY_ATTR {
        const hn::Rebind<std::int32_t, decltype(d)> d32;
        const hn::RebindToSigned<decltype(d)> d64;
        const auto index = hn::Load(d32, reinterpret_cast<const std::int32_t*>(place) + lane);
        return hn::GatherIndex(d, drawn.plane[k], hn::PromoteTo(d64, index));
      },
      wanted, t);
}

// The pixels of a block whose winner's exact answer is still to be computed, a bit each.
HWY_INLINE std::uint32_t UnknownBits(const TileState& state, int block) {
  const size_t first = static_cast<size_t>(block) * kBlockPixels;
  const hn::CappedTag<std::uint32_t, 16> d;
  std::uint32_t unknown = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const auto known = hn::Load(d, state.known + first + lane);
    unknown |= MaskBits(d, hn::Ne(hn::Load(d, state.winner + first + lane), known)) << lane;
  }
  return unknown;
}

// Of so many triangles of a block each has its pixels' depths computed by itself; then all that are left at
// once, each pixel with its own triangle, which takes as long as five.
constexpr int kByThemselves = 5;

// Notes who is known of a block's pixels whose bit is set: the triangle of that place and id, at the depths
// that are there already.
HWY_INLINE void NoteKnown(TileState& state, size_t first, std::uint32_t place, std::uint32_t pixels) {
  const hn::CappedTag<std::uint32_t, 16> d;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const auto mask = MaskOfBits(d, pixels >> lane);
    hn::BlendedStore(hn::Set(d, state.drawn.id[place]), mask, d, state.id + first + lane);
    hn::BlendedStore(hn::Set(d, place), mask, d, state.known + first + lane);
  }
}

// The same of each pixel's own triangle.
HWY_INLINE void NoteEachKnown(TileState& state, size_t first, std::uint32_t pixels) {
  for (std::uint32_t bits = pixels; bits != 0; bits &= bits - 1) {
    const size_t pixel = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
    const std::uint32_t place = state.winner[pixel];
    state.known[pixel] = place;
    state.id[pixel] = state.drawn.id[place];
  }
}

// Computes the exact answer of those of a block's pixels whose bit is set. A depth that turns out not to be
// certain is overwritten.
template <class Triangles>
inline void SettleBlock(const TileView& view, const Triangles& triangles, TileState& state, int block,
                        std::uint32_t unknown) {
  const size_t first = static_cast<size_t>(block) * kBlockPixels;
  const hn::CappedTag<std::uint32_t, 16> d;
  const std::uint32_t* winner = state.winner + first;
  const BlockRays rays(state, block);
  std::uint32_t left = unknown, open = 0;
  for (int i = 0; i < kByThemselves && left != 0; ++i) {
    const std::uint32_t sample = winner[hwy::Num0BitsBelowLS1Bit_Nonzero32(left)];
    std::uint32_t same = 0;
    for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d))
      same |= MaskBits(d, hn::Eq(hn::Load(d, winner + lane), hn::Set(d, sample))) << lane;
    same &= left;
    open |= same & ~BlockDepthsOf(rays, state.drawn, sample, same, state.t + first);
    NoteKnown(state, first, sample, same);
    left &= ~same;
  }
  if (left != 0) {
    HWY_ALIGN std::uint32_t place[kBlockPixels];
    for (size_t lane = 0; lane < kBlockPixels;
         lane += hn::Lanes(d)) {  // who is not asked is taken for the first
      const auto asked = MaskOfBits(d, left >> lane);
      hn::Store(hn::IfThenElseZero(asked, hn::Load(d, winner + lane)), d, place + lane);
    }
    open |= left & ~BlockDepthsOfEach(rays, state.drawn, place, left, state.t + first);
    NoteEachKnown(state, first, left);
  }
  for (; open != 0; open &= open - 1) {
    const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(open);
    learn_pixel(view, state, static_cast<int>(first + i), Placed(triangles, state, winner[i]));
  }
}

// Computes the exact answer of those of a block's pixels whose bit is set and whose winner is not known.
template <class Triangles>
inline void LearnBlock(const TileView& view, const Triangles& triangles, TileState& state, int block,
                       std::uint32_t pixels) {
  const std::uint32_t unknown = UnknownBits(state, block) & pixels;
  if (unknown == 0) return;
  SettleBlock(view, triangles, state, block, unknown);
}

// Computes the exact answer of every pixel.
template <class Triangles>
inline void LearnTile(const TileView& view, const Triangles& triangles, TileState& state) {
  for (int block = 0; block < kTileBlocks * kTileBlocks; ++block)
    LearnBlock(view, triangles, state, block, 0xffffu);
}

// Makes room for so many more drawn triangles.
template <class Triangles>
HWY_INLINE void MakeRoom(const TileView& view, const Triangles& triangles, TileState& state,
                         std::size_t count) {
  if (HWY_LIKELY(state.drawn.count + count <= DrawnTriangles::kRoom)) return;
  LearnTile(view, triangles, state);
  std::fill(std::begin(state.winner), std::end(state.winner), TileState::kEarlier);
  std::fill(std::begin(state.known), std::end(state.known), TileState::kEarlier);
  state.drawn.count = 0;
}

// Gives the frame what the tile won.
template <class Triangles>
inline void StoreTile(const TileView& view, const Triangles& triangles, TileState& state, Frame& frame) {
  LearnTile(view, triangles, state);
  ForEachRun(view, [&](size_t pixel, int offset, int pixels) HWY_ATTR {
    CopyRun(frame.depth.data() + pixel, state.t + offset, pixels);
    CopyRun(frame.id.data() + pixel, state.id + offset, pixels);
  });
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
