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
#include "pixels/axis_depths-inl.h"
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

// What gives the depths that a vector of pixels sees is N, T and PlaneBounds' of each one's triangle.

// All of one triangle.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void PlanesOf(D d, const DrawnTriangles& drawn, std::uint32_t place, V& nx, V& ny, V& nz, V& t_num,
                         V& a, V& b) {
  const double* const n = drawn.normal[place];
  nx = hn::Set(d, n[0]);
  ny = hn::Set(d, n[1]);
  nz = hn::Set(d, n[2]);
  t_num = hn::Set(d, n[3]);
  a = hn::Set(d, drawn.bounds[place][0]);
  b = hn::Set(d, drawn.bounds[place][1]);
}

// As many pairs of doubles as make a vector, of the places that are given.
template <class D>
HWY_INLINE hn::Vec<D> LoadPairs(D d, const double* pairs, size_t stride, const std::uint32_t* place) {
#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE
  if constexpr (hn::MaxLanes(d) > 2) {
    const hn::Half<D> half;
    return hn::Combine(d, LoadPairs(half, pairs, stride, place + hn::Lanes(half) / 2),
                       LoadPairs(half, pairs, stride, place));
  }
#endif
  return hn::LoadU(d, pairs + stride * place[0]);
}

// The two parts of a vector's worth of pairs. Where a vector's size is known that is faster than gathering
// them.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void SplitPairs(D d, const double* pairs, size_t stride, const std::uint32_t* place, V& first,
                           V& second) {
#if HWY_TARGET == HWY_SCALAR
  first = hn::Set(d, pairs[stride * place[0]]);
  second = hn::Set(d, pairs[stride * place[0] + 1]);
#elif HWY_HAVE_SCALABLE
  const hn::RebindToUnsigned<D> du;
  const hn::Rebind<std::uint32_t, D> d32;
  const auto index = hn::Mul(hn::PromoteTo(du, hn::LoadU(d32, place)), hn::Set(du, stride));
  first = hn::GatherIndex(d, pairs, hn::BitCast(hn::RebindToSigned<D>(), index));
  second = hn::GatherIndex(d, pairs + 1, hn::BitCast(hn::RebindToSigned<D>(), index));
#else
  const V low = LoadPairs(d, pairs, stride, place);
  const V high = LoadPairs(d, pairs, stride, place + hn::Lanes(d) / 2);
  if constexpr (hn::MaxLanes(d) == 2) {
    first = hn::InterleaveLower(d, low, high);
    second = hn::InterleaveUpper(d, low, high);
  } else {
    first = hn::ConcatEven(d, high, low);
    second = hn::ConcatOdd(d, high, low);
  }
#endif
}

// Each pixel's own triangle, whose place is given.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void PlanesOfEach(D d, const DrawnTriangles& drawn, const std::uint32_t* place, V& nx, V& ny,
                             V& nz, V& t_num, V& a, V& b) {
  SplitPairs(d, drawn.normal[0], 4, place, nx, ny);
  SplitPairs(d, drawn.normal[0] + 2, 4, place, nz, t_num);
  SplitPairs(d, drawn.bounds[0], 2, place, a, b);
}

// RN32 of the ends of the intervals of t (exact/depth-inl.h) of a block's pixels from `lane` on, of whose
// triangles `planes(d, lane, ...)` gives what the functions above do.
template <class D, class Planes, class VF = hn::Vec<hn::Rebind<float, D>>>
HWY_INLINE void DepthEnds(D d, const BlockRays& rays, const Planes& planes, size_t lane, VF& least,
                          VF& greatest) {
  auto nx = hn::Zero(d), ny = nx, nz = nx, t_num = nx, a = nx, b = nx;
  planes(d, lane, nx, ny, nz, t_num, a, b);
  const auto ray = [&](int axis) HWY_ATTR { return hn::Load(d, rays.direction[axis] + lane); };
  PlaneEnds(d, ray(0), ray(1), ray(2), nx, ny, nz, t_num, a, b, least, greatest);
}

// The depths that a block's pixels see. Where a bit of `wanted` is set it is stored to `t`; returns those of
// them that are certain.
template <class Planes>
HWY_INLINE std::uint32_t BlockDepths(const BlockRays& rays, const Planes& planes, std::uint32_t wanted,
                                     float* t) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  std::uint32_t bits = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    auto least = hn::Zero(df), greatest = hn::Zero(df);
    DepthEnds(d, rays, planes, lane, least, greatest);
    hn::BlendedStore(least, MaskOfBits(df, wanted >> lane), df, t + lane);
    bits |= MaskBits(df, CertainDepths(df, least, greatest)) << lane;
  }
  return bits & wanted;
}

// One triangle for all pixels, for DepthEnds().
HWY_INLINE auto OneTriangle(const DrawnTriangles& drawn, std::uint32_t place) {
  return [&drawn, place](auto d, size_t, auto& nx, auto& ny, auto& nz, auto& t_num, auto& a, auto& b)
             HWY_ATTR { PlanesOf(d, drawn, place, nx, ny, nz, t_num, a, b); };
}

// Depths of one triangle.
HWY_INLINE std::uint32_t BlockDepthsOf(const BlockRays& rays, const DrawnTriangles& drawn,
                                       std::uint32_t place, std::uint32_t wanted, float* t) {
  return BlockDepths(rays, OneTriangle(drawn, place), wanted, t);
}

// Of each pixel's own triangle, whose places are given.
HWY_INLINE std::uint32_t BlockDepthsOfEach(const BlockRays& rays, const DrawnTriangles& drawn,
                                           const std::uint32_t* place, std::uint32_t wanted, float* t) {
  return BlockDepths(
      rays,
      [&](auto d, size_t lane, auto& nx, auto& ny, auto& nz, auto& t_num, auto& a, auto& b)
          HWY_ATTR { PlanesOfEach(d, drawn, place + lane, nx, ny, nz, t_num, a, b); },
      wanted, t);
}

// One triangle's depths of as many of a block's pixels as a whole vector of floats has, and where they are
// certain.
template <class DF, class VF = hn::Vec<DF>>
HWY_INLINE VF DepthsOf(DF df, const BlockRays& rays, const DrawnTriangles& drawn, std::uint32_t place,
                       size_t lane, hn::Mask<DF>& certain) {
  const auto planes = OneTriangle(drawn, place);
#if HWY_TARGET == HWY_SCALAR
  auto least = hn::Zero(df), greatest = hn::Zero(df);
  DepthEnds(hn::Rebind<double, DF>(), rays, planes, lane, least, greatest);
#else
  const hn::Half<DF> half;
  const hn::Rebind<double, decltype(half)> d;
  auto least0 = hn::Zero(half), greatest0 = least0, least1 = least0, greatest1 = least0;
  DepthEnds(d, rays, planes, lane, least0, greatest0);
  DepthEnds(d, rays, planes, lane + hn::Lanes(half), least1, greatest1);
  const auto least = hn::Combine(df, least1, least0), greatest = hn::Combine(df, greatest1, greatest0);
#endif
  certain = CertainDepths(df, least, greatest);
  return least;
}

// As BlockDepths() for pixels that one triangle certainly covers, at depths too near to a midpoint of floats
// for that: those of planes across an axis.
HWY_NOINLINE inline std::uint32_t BlockTies(const TileView& view, const TileState& state, int block,
                                            const Triangle& triangle, std::uint32_t wanted, float* t) {
  const AxisPlane plane = axis_plane(view.camera.eye, triangle);
  if (plane.axis < 0) return 0;
  // Made again: were the caller's looked at from here, it would have to keep them in memory.
  const BlockRays rays(state, block);
  return AxisDepths(plane.distance, rays.direction[plane.axis], wanted, t);
}

// Those of a block's pixels, of `asked`, that the first one's winner has won; which is `place`.
HWY_INLINE std::uint32_t PixelsOfFirst(const std::uint32_t* winner, std::uint32_t asked,
                                       std::uint32_t& place) {
  const hn::CappedTag<std::uint32_t, 16> d;
  place = winner[hwy::Num0BitsBelowLS1Bit_Nonzero32(asked)];
  std::uint32_t same = 0;
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d))
    same |= MaskBits(d, hn::Eq(hn::Load(d, winner + lane), hn::Set(d, place))) << lane;
  return same & asked;
}

// Puts the exact depths of a triangle into `t` for pixels that it certainly covers.
template <class Triangles>
HWY_INLINE void LearnPixels(const TileView& view, const Triangles& triangles, TileState& state, int block,
                            std::uint32_t place, std::uint32_t pixels) {
  const PlacedTriangle placed = Placed(triangles, state, place);
  const int first = block * kBlockPixels;
  pixels &= ~BlockTies(view, state, block, placed.corners, pixels, state.t + first);
  for (; pixels != 0; pixels &= pixels - 1)
    learn_pixel(view, state, first + static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero32(pixels)), placed);
}

// Computes the exact answer of those of a block's pixels whose bit is set. A depth that turns out not to be
// certain is overwritten.
template <class Triangles>
inline void SettleBlock(const TileView& view, const Triangles& triangles, TileState& state, int block,
                        std::uint32_t unknown) {
  const size_t first = static_cast<size_t>(block) * kBlockPixels;
  const hn::CappedTag<std::uint32_t, 16> d;
  const std::uint32_t* const winner = state.winner + first;
  float* const t = state.t + first;
  std::uint32_t* const id = state.id + first;
  const BlockRays rays(state, block);
  std::uint32_t place0 = 0, place1 = 0, certain = 0;
  const std::uint32_t pixels0 = PixelsOfFirst(winner, unknown, place0);
  const std::uint32_t rest = unknown & ~pixels0;
  const std::uint32_t pixels1 = rest == 0 ? 0 : PixelsOfFirst(winner, rest, place1);
  if (rest == pixels1) {  // one triangle, or two
    certain = BlockDepthsOf(rays, state.drawn, place0, pixels0, t);
    if (rest != 0) certain |= BlockDepthsOf(rays, state.drawn, place1, pixels1, t);
    const auto id0 = hn::Set(d, state.drawn.id[place0]), id1 = hn::Set(d, state.drawn.id[place1]);
    for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
      const auto both = hn::IfThenElse(MaskOfBits(d, pixels0 >> lane), id0, id1);
      hn::BlendedStore(both, MaskOfBits(d, unknown >> lane), d, id + lane);
    }
  } else {
    HWY_ALIGN std::uint32_t place[kBlockPixels];
    for (size_t lane = 0; lane < kBlockPixels;
         lane += hn::Lanes(d)) {  // who is not asked is taken for the first
      const auto asked = MaskOfBits(d, unknown >> lane);
      hn::Store(hn::IfThenElseZero(asked, hn::Load(d, winner + lane)), d, place + lane);
    }
    certain = BlockDepthsOfEach(rays, state.drawn, place, unknown, t);
    const hn::RebindToSigned<decltype(d)> di;
    for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
      const auto index = hn::BitCast(di, hn::Load(d, place + lane));
      hn::BlendedStore(hn::GatherIndex(d, state.drawn.id, index), MaskOfBits(d, unknown >> lane), d,
                       id + lane);
    }
  }
  std::uint32_t open = unknown & ~certain;
  state.settled[block] |= static_cast<std::uint16_t>(unknown);
  while (HWY_UNLIKELY(open != 0)) {
    std::uint32_t place = 0;
    const std::uint32_t same = PixelsOfFirst(winner, open, place);
    LearnPixels(view, triangles, state, block, place, same);
    open &= ~same;
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
  const BlockRays rays(state, block);
  const std::uint32_t open = 0xffffu & ~BlockDepthsOf(rays, state.drawn, winner, 0xffffu, state.t + first);
  if (HWY_UNLIKELY(open != 0)) LearnPixels(view, triangles, state, block, winner, open);
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
