#include "scene/track.h"

#include <cmath>
#include <numbers>

namespace plumb::detail {

double Track::length() const { return 4.0 * (half_x + half_z) + 2.0 * std::numbers::pi * radius; }

TrackSpot Track::spot(double share) const {
  // One quarter is half of +x's side, a corner and half of +z's side; by symmetry the others are its
  // mirror images, run through forward or backward.
  const double quarter = std::floor(4.0 * share);
  const bool mirrored = quarter == 1.0 || quarter == 3.0;
  const double in_quarter = 4.0 * share - quarter;
  const double along = (mirrored ? 1.0 - in_quarter : in_quarter) * (0.25 * length());
  const double arc = 0.5 * std::numbers::pi * radius;
  TrackSpot spot{half_x, half_z, 0.0, 0.0};
  if (along < half_z) {
    spot = {half_x + radius, along, 1.0, 0.0};
  } else if (along < half_z + arc) {
    const Turn corner = turn(0.25 * ((along - half_z) / arc));
    spot = {half_x + radius * corner.cos, half_z + radius * corner.sin, corner.cos, corner.sin};
  } else {
    spot = {half_x - (along - half_z - arc), half_z + radius, 0.0, 1.0};
  }
  const bool negative_x = quarter == 1.0 || quarter == 2.0;
  const bool negative_z = quarter == 2.0 || quarter == 3.0;
  if (negative_x) spot.x = -spot.x, spot.normal_x = -spot.normal_x;
  if (negative_z) spot.z = -spot.z, spot.normal_z = -spot.normal_z;
  return spot;
}

}  // namespace plumb::detail
