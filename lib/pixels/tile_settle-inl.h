// Exact answers of a tile's pixels, a block at a time. Included once per Highway target.

#if defined(PLUMB_PIXELS_TILE_SETTLE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_TILE_SETTLE_INL_H_
#undef PLUMB_PIXELS_TILE_SETTLE_INL_H_
#else
#define PLUMB_PIXELS_TILE_SETTLE_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "base/mask_bits-inl.h"
#include "exact/depth-inl.h"
#include "hwy/highway.h"
#include "pixels/pixel_direction-inl.h"
#include "pixels/tile_bounds-inl.h"
#include "pixels/tile_state.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

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

// RN32 of the ends of the intervals of t (exact/depth-inl.h) of a block's pixels from `lane` on;
// `plane(d, k, lane)` gives DrawnTriangles' planes of their triangles.
template <class DF, class Plane, class VF = hn::Vec<DF>>
HWY_INLINE void DepthEnds(DF df, const BlockRays& rays, const Plane& plane, size_t lane, VF& least,
                          VF& greatest) {
  const hn::Rebind<double, DF> d;
  const auto ray = [&](int axis) HWY_ATTR { return hn::Load(d, rays.direction[axis] + lane); };
  const auto of = [&](int k) HWY_ATTR { return plane(d, k, lane); };
  PlaneEnds(d, ray(0), ray(1), ray(2), of(0), of(1), of(2), of(3), of(4), of(5), least, greatest);
}

// The depths that a block's pixels see. Where a bit of `wanted` is set it is stored to `t`; returns those of
// them that are certain.
template <class Plane>
HWY_INLINE std::uint32_t BlockDepths(const BlockRays& rays, const Plane& plane, std::uint32_t wanted,
                                     float* t) {
  const hn::Rebind<float, hn::CappedTag<double, 8>> d;
  std::uint32_t bits = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    auto least = hn::Zero(d), greatest = hn::Zero(d);
    DepthEnds(d, rays, plane, lane, least, greatest);
    hn::BlendedStore(least, MaskOfBits(d, wanted >> lane), d, t + lane);
    bits |= MaskBits(d, CertainDepths(d, least, greatest)) << lane;
  }
  return bits & wanted;
}

// DrawnTriangles' planes of one triangle, for DepthEnds().
HWY_INLINE auto PlanesOf(const DrawnTriangles& drawn, std::uint32_t place) {
  return [&drawn, place](auto d, int k, size_t) HWY_ATTR { return hn::Set(d, drawn.plane[k][place]); };
}

// Of one triangle.
HWY_INLINE std::uint32_t BlockDepthsOf(const BlockRays& rays, const DrawnTriangles& drawn,
                                       std::uint32_t place, std::uint32_t wanted, float* t) {
  return BlockDepths(rays, PlanesOf(drawn, place), wanted, t);
}

// One triangle's depths of as many of a block's pixels as a whole vector of floats has, and where they are
// certain.
template <class DF, class VF = hn::Vec<DF>>
HWY_INLINE VF DepthsOf(DF df, const BlockRays& rays, const DrawnTriangles& drawn, std::uint32_t place,
                       size_t lane, hn::Mask<DF>& certain) {
#if HWY_TARGET == HWY_SCALAR
  auto least = hn::Zero(df), greatest = hn::Zero(df);
  DepthEnds(df, rays, PlanesOf(drawn, place), lane, least, greatest);
#else
  const hn::Half<DF> half;
  auto least0 = hn::Zero(half), greatest0 = hn::Zero(half), least1 = hn::Zero(half),
       greatest1 = hn::Zero(half);
  DepthEnds(half, rays, PlanesOf(drawn, place), lane, least0, greatest0);
  DepthEnds(half, rays, PlanesOf(drawn, place), lane + hn::Lanes(half), least1, greatest1);
  const auto least = hn::Combine(df, least1, least0), greatest = hn::Combine(df, greatest1, greatest0);
#endif
  certain = CertainDepths(df, least, greatest);
  return least;
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

// Of so many triangles of a block each has its pixels' depths computed by itself; then all that are left at
// once, each pixel with its own triangle, which takes as long as five.
constexpr int kByThemselves = 5;

// Notes the id of a block's pixels whose bit is set.
HWY_INLINE void NoteId(TileState& state, size_t first, std::uint32_t id, std::uint32_t pixels) {
  const hn::CappedTag<std::uint32_t, 16> d;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d))
    hn::BlendedStore(hn::Set(d, id), MaskOfBits(d, pixels >> lane), d, state.id + first + lane);
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
    NoteId(state, first, state.drawn.id[sample], same);
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
    for (std::uint32_t bits = left; bits != 0; bits &= bits - 1) {
      const size_t pixel = first + hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
      state.id[pixel] = state.drawn.id[state.winner[pixel]];
    }
  }
  state.settled[block] |= static_cast<std::uint16_t>(unknown);
  for (; open != 0; open &= open - 1) {
    const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(open);
    learn_pixel(view, state, static_cast<int>(first + i), Placed(triangles, state, winner[i]));
  }
}

// Computes the exact answer of those of a block's pixels whose bit is set and whose answer is not known. The
// block is not whole.
template <class Triangles>
HWY_INLINE void LearnBlock(const TileView& view, const Triangles& triangles, TileState& state, int block,
                           std::uint32_t pixels) {
  const std::uint32_t unknown = ~std::uint32_t{state.settled[block]} & pixels;
  if (unknown != 0) SettleBlock(view, triangles, state, block, unknown);
}

// Puts the exact answer of a whole block into `t` and `id`.
template <class Triangles>
HWY_INLINE void SettleWhole(const TileView& view, const Triangles& triangles, TileState& state, int block) {
  const size_t first = static_cast<size_t>(block) * kBlockPixels;
  const std::uint32_t winner = state.block_winner[block];
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const bool empty = winner == TileState::kEarlier;
  const auto id = hn::Set(du, empty ? kNone : state.drawn.id[winner]);
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) hn::Store(id, du, state.id + first + lane);
  if (empty) {
    for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d))
      hn::Store(hn::Set(d, kFloatInfinity), d, state.t + first + lane);
    return;
  }
  std::uint32_t open =
      0xffffu & ~BlockDepthsOf(BlockRays(state, block), state.drawn, winner, 0xffffu, state.t + first);
  for (; HWY_UNLIKELY(open != 0); open &= open - 1) {
    const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(open);
    learn_pixel(view, state, static_cast<int>(first + i), Placed(triangles, state, winner));
  }
}

// Puts the exact answer of every pixel of a row of blocks into `t` and `id`.
template <class Triangles>
HWY_INLINE void SettleRow(const TileView& view, const Triangles& triangles, TileState& state, int row) {
  for (int block = row * kTileBlocks; block < (row + 1) * kTileBlocks; ++block) {
    if ((state.whole >> block & 1) != 0) {
      SettleWhole(view, triangles, state, block);
    } else {
      LearnBlock(view, triangles, state, block, 0xffffu);
    }
  }
}

// Makes room for so many more drawn triangles: what they won is settled.
template <class Triangles>
HWY_NOINLINE inline void ForgetDrawn(const TileView& view, const Triangles& triangles, TileState& state) {
  for (int block = 0; block < kTileBlocks * kTileBlocks; ++block) {
    PartIfWhole(state, block);
    LearnBlock(view, triangles, state, block, 0xffffu);
  }
  std::fill(std::begin(state.winner), std::end(state.winner), TileState::kEarlier);
  state.drawn.count = 0;
}

template <class Triangles>
HWY_INLINE void MakeRoom(const TileView& view, const Triangles& triangles, TileState& state,
                         std::size_t count) {
  if (HWY_LIKELY(state.drawn.count + count <= DrawnTriangles::kRoom)) return;
  ForgetDrawn(view, triangles, state);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
