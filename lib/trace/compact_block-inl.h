// Blocks of a compact tree, made plain again: a table look-up by the vector where the target's registers
// hold a block's vertices, scalar copies elsewhere. Included once per Highway target.

#if defined(PLUMB_TRACE_COMPACT_BLOCK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_COMPACT_BLOCK_INL_H_
#undef PLUMB_TRACE_COMPACT_BLOCK_INL_H_
#else
#define PLUMB_TRACE_COMPACT_BLOCK_INL_H_
#endif

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "hwy/highway.h"
#include "plumb/mesh.h"
#include "wide/compact_tree.h"
#include "wide/triangle_block.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <int W>
HWY_INLINE const float* PositionsOf(const unsigned char* packed, int axis) {
  const std::size_t vertices = packed[CompactLayout<W>::kVertices];
  return reinterpret_cast<const float*>(packed + CompactLayout<W>::kPosition) +
         vertices * static_cast<std::size_t>(axis);
}

template <int W>
HWY_INLINE void CopyCorners(const unsigned char* packed, TriangleBlock<W>& block) {
  for (int axis = 0; axis < 3; ++axis) {
    const float* const positions = PositionsOf<W>(packed, axis);
    for (int v = 0; v < 3; ++v) {
      for (int lane = 0; lane < W; ++lane) block.vertex[v][axis][lane] = positions[packed[v * W + lane]];
    }
  }
}

// Returns false where that cannot be done by the vector. Loads go beyond the positions, into what follows in
// the tree's units, but no corner takes any of that.
HWY_INLINE bool LookUpCorners(const unsigned char* packed, TriangleBlock<8>& block) {
#if HWY_MAX_BYTES >= 32 && !HWY_HAVE_SCALABLE
  if (HWY_UNLIKELY(packed[CompactLayout<8>::kVertices] > 16)) return false;
  const hn::FixedTag<float, 8> d;
  const hn::FixedTag<std::uint8_t, 16> d8;
  for (int v = 0; v < 3; ++v) {
    // The places past the eight lanes are some corners' as well, or the count of vertices.
    const auto corners = hn::And(hn::LoadU(d8, packed + 8 * v), hn::Set(d8, 15));
#if HWY_MAX_BYTES >= 64
    const hn::FixedTag<float, 16> table;
    const auto places =
        hn::IndicesFromVec(table, hn::PromoteTo(hn::RebindToSigned<decltype(table)>(), corners));
    for (int axis = 0; axis < 3; ++axis) {
      const auto found = hn::TableLookupLanes(hn::LoadU(table, PositionsOf<8>(packed, axis)), places);
      hn::Store(hn::LowerHalf(d, found), d, block.vertex[v][axis]);
    }
#else
    const hn::RebindToSigned<decltype(d)> di;
    const auto eight = hn::PromoteTo(di, hn::LowerHalf(corners));
    const auto places = hn::IndicesFromVec(d, hn::And(eight, hn::Set(di, 7)));
    const auto second = hn::RebindMask(d, hn::Gt(eight, hn::Set(di, 7)));
    for (int axis = 0; axis < 3; ++axis) {
      const float* const positions = PositionsOf<8>(packed, axis);
      const auto low = hn::TableLookupLanes(hn::LoadU(d, positions), places);
      const auto high = hn::TableLookupLanes(hn::LoadU(d, positions + 8), places);
      hn::Store(hn::IfThenElse(second, high, low), d, block.vertex[v][axis]);
    }
#endif
  }
  return true;
#else
  (void)packed;
  (void)block;
  return false;
#endif
}

// TriangleBlock::extent, of the lanes' coordinates. The two sums are rounded, and so is the product: of the
// exact sum of the computed differences it is at least (1 - u)^3 (1 + 8 u) times, u = 2^-24, and so above
// that sum in any order, which is at most (1 + u)^2 times.
template <int W>
HWY_INLINE void SetExtents(TriangleBlock<W>& block) {
  const hn::CappedTag<float, W> d;
  using V = hn::Vec<decltype(d)>;
  for (size_t i = 0; i < static_cast<size_t>(W); i += hn::Lanes(d)) {
    const auto length = [&](int v) HWY_ATTR {
      V sum = hn::Zero(d);
      for (int axis = 0; axis < 3; ++axis) {
        sum = hn::Add(sum, hn::Abs(hn::Sub(hn::Load(d, block.vertex[v][axis] + i),
                                           hn::Load(d, block.vertex[0][axis] + i))));
      }
      return sum;
    };
    const V greatest = hn::Mul(hn::Max(length(1), length(2)), hn::Set(d, 1.0f + 8 * 0x1p-24f));
    hn::Store(hn::Max(greatest, hn::Set(d, 0x1p-30f)), d, block.extent + i);
  }
}

template <int W>
HWY_INLINE void Unpack(const unsigned char* packed, TriangleBlock<W>& block) {
  if (!LookUpCorners(packed, block)) CopyCorners(packed, block);
  SetExtents(block);
  std::memcpy(block.id, packed + CompactLayout<W>::kId, sizeof block.id);
}

// Triangle `lane` of a block alone, and its id.
template <int W>
HWY_INLINE Triangle TriangleOf(const unsigned char* packed, size_t lane) {
  const auto corner = [&](size_t v) {
    const size_t place = packed[v * W + lane];
    return glm::vec3(PositionsOf<W>(packed, 0)[place], PositionsOf<W>(packed, 1)[place],
                     PositionsOf<W>(packed, 2)[place]);
  };
  return {corner(0), corner(1), corner(2)};
}

template <int W>
HWY_INLINE std::uint32_t IdOf(const unsigned char* packed, size_t lane) {
  std::uint32_t id;
  std::memcpy(&id, packed + CompactLayout<W>::kId + 4 * lane, sizeof id);
  return id;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
