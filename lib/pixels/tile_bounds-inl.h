// Bounds of the 1/t that a tile's pixels and blocks see, by the vector. Included once per Highway target.

#if defined(PLUMB_PIXELS_TILE_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_TILE_BOUNDS_INL_H_
#undef PLUMB_PIXELS_TILE_BOUNDS_INL_H_
#else
#define PLUMB_PIXELS_TILE_BOUNDS_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
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

// Takes the least bound anew of a block that is not whole.
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
  for (std::uint64_t blocks = state.changed & ~state.whole; blocks != 0; blocks &= blocks - 1)
    UpdateBlock(state, static_cast<int>(hwy::Num0BitsBelowLS1Bit_Nonzero64(blocks)));
  state.changed = 0;
  const hn::CappedTag<float, 16> d;
  auto least = hn::Load(d, state.block_low);
  for (size_t i = hn::Lanes(d); i < kTileBlocks * kTileBlocks; i += hn::Lanes(d))
    least = hn::Min(least, hn::Load(d, state.block_low + i));
  state.tile_low = hn::GetLane(hn::MinOfLanes(d, least));
}

// The centres of a block's pixels from `lane` on, from the tile's.
template <class D, class V = hn::Vec<D>>
HWY_INLINE void PixelCentres(D d, int block, size_t lane, V& x, V& y) {
  x = hn::Add(hn::Set(d, kCentres.block_x[block]), hn::Load(d, kCentres.pixel_x + lane));
  y = hn::Add(hn::Set(d, kCentres.block_y[block]), hn::Load(d, kCentres.pixel_y + lane));
}

// A plane there.
template <class D, class V = hn::Vec<D>>
HWY_INLINE V PlaneAt(D d, float a, float b, float c, V x, V y) {
  return hn::MulAdd(hn::Set(d, a), x, hn::MulAdd(hn::Set(d, b), y, hn::Set(d, c)));
}

// Gives each pixel of a whole block what it is to have of its own.
inline void PartBlock(TileState& state, int block) {
  const hn::CappedTag<float, 16> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  const std::uint32_t winner = state.block_winner[block];
  const bool empty = winner == TileState::kEarlier;
  const InversePlane plane = empty ? InversePlane{} : state.drawn.inverse[winner];
  for (size_t lane = 0; lane < kBlockPixels; lane += hn::Lanes(d)) {
    const size_t offset = static_cast<size_t>(block * kBlockPixels) + lane;
    hn::Store(hn::Set(du, winner), du, state.winner + offset);
    if (empty) {
      hn::Store(hn::Set(d, -kFloatInfinity), d, state.inverse_low + offset);
      hn::Store(hn::Set(d, TileState::kLeastInverse), d, state.inverse_high + offset);
      hn::Store(hn::Set(d, kFloatInfinity), d, state.t + offset);
      hn::Store(hn::Set(du, kNone), du, state.id + offset);
    } else {
      auto x = hn::Zero(d), y = hn::Zero(d);
      PixelCentres(d, block, lane, x, y);
      const auto inverse = PlaneAt(d, plane.a, plane.b, plane.c, x, y);
      hn::Store(hn::Sub(inverse, hn::Set(d, plane.error)), d, state.inverse_low + offset);
      hn::Store(hn::Add(inverse, hn::Set(d, plane.error)), d, state.inverse_high + offset);
    }
  }
  state.settled[block] = empty ? 0xffffu : 0;
  state.block_high[block] = kFloatInfinity;
  state.whole &= ~(std::uint64_t{1} << block);
}

// The same of a block that may be whole.
HWY_INLINE void PartIfWhole(TileState& state, int block) {
  if ((state.whole >> block & 1) != 0) PartBlock(state, block);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
