#pragma once

#include <cstddef>
#include <cstdint>

#include "base/float4.h"
#include "build/triangle_refs.h"

// Binning (Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies"): triangles are
// counted and their boxes joined in equal slices of each axis, by the centres of their boxes, and
// the planes between slices are the candidates for a split.

namespace plumb::detail {

inline constexpr int kMaxBins = 32;

/// Which bin a triangle falls into, on each axis. Every loop that asks this gets the same answer, for
/// the scalar and the vector operations round alike.
class BinMap {
 public:
  /// `centres` holds the triangles' doubled centres, in the scene's unit.
  BinMap(const Box4& centres, float unit, int bins);

  int bins() const { return bins_; }
  Float4 unit() const { return unit_; }
  Int4 bin(Float4 doubled_centre) const { return truncate((doubled_centre - origin_) * scale_); }

 private:
  Float4 unit_;
  Float4 origin_;
  Float4 scale_;  // 0 on an axis where the centres lie too close for bins: all fall into bin 0
  int bins_;
};

/// A split: bins below `bin` of the axis go left.
struct SahSplit {
  int axis = -1;  ///< -1: the centres do not differ on any axis
  int bin = 0;
  float cost = 0;  ///< sum over both sides of (half the area) * (blocks of triangles), in the scene's unit
};

/// The bins of all three axes.
class SahBins {
 public:
  void clear(int bins);
  void add(const TriangleRef* refs, std::size_t count, const BinMap& map);
  void add(const SahBins& other);

  /// The split of least cost; among equals the one that halves the triangles best, then the first. A
  /// block is 1 << block_shift triangles, and a part of one costs as much as the whole.
  SahSplit best_split(Float4 unit, int block_shift) const;

  /// Triangles on the left of a split.
  std::size_t count_left(const SahSplit& split) const;
  /// Both sides' boxes.
  void boxes(const SahSplit& split, Box4& left, Box4& right) const;

 private:
  // Half of the three boxes' areas, in lanes 0, 1, 2.
  static Float4 half_areas(const Box4* boxes, Float4 unit);

  int bins_ = 0;
  Int4 count_[kMaxBins];  // lane: axis
  Box4 box_[kMaxBins][3];
};

/// The three terms of half a box's area, in the scene's unit.
inline Float4 half_area_terms(const Box4& box, Float4 unit) {
  const Float4 size = box.hi * unit - box.lo * unit;
  return size * __builtin_shufflevector(size, size, 1, 2, 0, 3);
}

/// Half the area of a box, in the scene's unit.
inline float half_area(const Box4& box, Float4 unit) {
  const Float4 terms = half_area_terms(box, unit);
  return (terms[0] + terms[1]) + terms[2];
}

/// Copies the triangles to `left` and `right` by the split, keeping their order, and sets the box of each
/// side's doubled centres. Both lie in one array, apart from `refs`.
void partition(const TriangleRef* refs, std::size_t count, const BinMap& map, const SahSplit& split,
               TriangleRef* left, TriangleRef* right, Box4 centres[2]);

}  // namespace plumb::detail
