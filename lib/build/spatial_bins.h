#pragma once

#include <cstddef>
#include <vector>

#include "base/float4.h"
#include "build/triangle_refs.h"
#include "plumb/mesh.h"

// Spatial splits (Stich, Friedrich and Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies"),
// binned: the box of a range is cut in equal slices of each axis, and a reference that lies in several counts
// in each of those that it is split by.

namespace plumb::detail {

inline constexpr int kMaxSpatialBins = 16;

/// A plane to split references at.
struct SpatialSplit {
  int axis = -1;  ///< -1: there is none
  float plane = 0;
  float cost = 0;  ///< as SahSplit's
  // About as many references and as large a box as either side gets.
  float count[2] = {0, 0};
  Box4 box[2];
};

/// The bins of all three axes.
class SpatialBins {
 public:
  void clear(const Box4& box, int bins);
  void add(const TriangleRef* refs, std::size_t count, MeshView mesh);
  void add(const SpatialBins& other);

  /// The split of least cost; among equals the first.
  SpatialSplit best_split(Float4 unit, int block_shift) const;

 private:
  float plane(int axis, int bin) const { return lo_[axis] + static_cast<float>(bin) * step_[axis]; }

  int bins_ = 0;
  Float4 lo_, step_, scale_;                              // scale 0 on an axis that is not to be split
  Int4 enter_[kMaxSpatialBins], leave_[kMaxSpatialBins];  // lane: axis
  Box4 box_[kMaxSpatialBins][3];
};

/// Copies the references to the end of `left` and `right` by the split, keeping their order. One that lies on
/// both sides is split, unless the whole of it at one side is cheaper (the paper's reference
/// unsplitting; here every one is judged by the split's counts and boxes, so that their order does not
/// matter).
void split_references(const TriangleRef* refs, std::size_t count, const SpatialSplit& split, MeshView mesh,
                      Float4 unit, std::vector<TriangleRef>& left, std::vector<TriangleRef>& right);

}  // namespace plumb::detail
