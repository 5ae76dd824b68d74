#pragma once

#include "scene/mesh_builder.h"

namespace plumb::detail {

/// A point of a closed curve seen from above, and the unit normal that points out of it.
struct TrackSpot {
  double x, z;
  double normal_x, normal_z;

  /// The point `offset` further out, at height `y`.
  glm::dvec3 at(double offset, double y) const { return {x + offset * normal_x, y, z + offset * normal_z}; }
};

/// The outline that stands and running tracks have: a rectangle of half sizes (half_x, half_z), grown
/// by `radius`. A track of another radius is its parallel curve.
struct Track {
  double half_x, half_z, radius;

  double length() const;
  /// The spot at `share` (0 to 1) of the length, from the middle of +x's side toward +z.
  TrackSpot spot(double share) const;
};

}  // namespace plumb::detail
