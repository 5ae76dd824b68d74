#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "base/aligned.h"
#include "build/triangle_refs.h"

// Morton 1966, "A computer oriented geodetic data base and a new technique in file sequencing": places in the
// order of a curve that fills space, so that neighbours in the order are neighbours in space.

namespace plumb::detail {

/// A triangle's place on the curve in the upper half, its index into the TriangleRefs in the lower.
using MortonKey = std::uint64_t;

inline std::uint32_t morton_code(MortonKey key) { return static_cast<std::uint32_t>(key >> 32); }
inline std::uint32_t morton_item(MortonKey key) { return static_cast<std::uint32_t>(key); }

inline constexpr int kMortonBits = 30;

/// Where a point lies on a curve through a box. Each bit of a code halves the longest axis of the cell that
/// those above it have left (Vinkler, Bittner and Havran 2017, "Extended Morton Codes for High Performance
/// Bounding Volume Hierarchy Construction"), which keeps cells of flat scenes compact.
class MortonMap {
 public:
  /// `centres` holds the triangles' doubled centres, in the scene's unit.
  MortonMap(const Box4& centres, float unit);

  MortonKey key(const TriangleRef& ref, std::uint32_t item) const {
    const Int4 cell = truncate((doubled_centre(ref, unit_) - origin_) * scale_);
    std::uint32_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const auto at = static_cast<std::uint32_t>(cell[axis]);
      code |= spread_[axis][0][at & 0xff] | spread_[axis][1][at >> 8];
    }
    return MortonKey{code} << 32 | item;
  }

 private:
  static constexpr int kAxisBits = 16;

  Float4 unit_, origin_, scale_;
  std::uint32_t spread_[3][2][256];  // the code's bits of either half of a place on an axis
};

/// The keys of all triangles, sorted. Call it in an arena.
UnsetVector<MortonKey> morton_order(const TriangleRefs& refs);

}  // namespace plumb::detail
