#pragma once

#include <limits>

#include "build/binary_tree.h"
#include "plumb/ray.h"

namespace plumb::detail {

/// Bounds of the t at which a ray meets a plane across an axis.
struct PlaneInterval {
  double lo, hi;
};

/// A valid ray against planes across the axes, in double, for structures of cells.
///
/// The exact t of a plane x = p is (p - o) / d. The computed difference, the inverse and their product each
/// round once: an error below 3.01 u |t|, u = 2^-53. One inverse is shrunk by 2^-50 = 8 u, the other grown,
/// so that for t > 0 the products bound t from below and above; for t < 0 both are negative, if in the other
/// order, and every t that counts is above 0; and t = 0 gives 0 twice. The differences of floats are 0
/// or between 2^-149 and 2^129 and a float's inverse between 2^-128 and 2^149: nothing overflows or
/// underflows.
///
/// Across an axis that the ray does not move along, the inverses are infinite and taken as forward: a plane
/// above the origin is met at +inf, one below at -inf, and one through the origin at NaN, for which every
/// comparison below is false. What follows from these for a split of an interval of t by a plane:
///
///     lo > exit     everything is on the near side of the plane
///     hi < entry    everything is on its far side
///     neither       either side may hold points, the near one up to hi, the far one from lo on; where these
///                   are NaN, the old ends stay
///
/// A point of the plane itself with a t that counts is looked for on both sides, always: its t is neither
/// below lo nor above hi. So a structure may keep what lies in a plane on either side of it.
class PlaneRay {
 public:
  explicit PlaneRay(const Ray& ray) : tmin_(ray.tmin > 0.0f ? double{ray.tmin} : 0.0) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto d = double{ray.direction[axis]};
      origin_[axis] = double{ray.origin[axis]};
      const double inverse = d == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / d;
      inverse_lo_[axis] = inverse * (1.0 - 0x1p-50);
      inverse_hi_[axis] = inverse * (1.0 + 0x1p-50);
      forward_[axis] = inverse > 0.0;
    }
  }

  /// Whether the ray goes up along the axis, or stays: then a plane's lower side is the near one.
  bool forward(int axis) const { return forward_[axis]; }

  PlaneInterval meet(int axis, float plane) const {
    const double difference = double{plane} - origin_[axis];
    return {difference * inverse_lo_[axis], difference * inverse_hi_[axis]};
  }

  /// Whether a point of the closed box may have a t that counts and is at most `limit`; then these lie
  /// between `entry`, at least max(tmin, 0), and `exit`.
  bool meets(const Box& box, float limit, double& entry, double& exit) const {
    entry = tmin_;
    exit = double{limit};
    for (int axis = 0; axis < 3; ++axis) {
      const bool up = forward_[axis];
      const double lo = meet(axis, up ? box.lo[axis] : box.hi[axis]).lo;
      const double hi = meet(axis, up ? box.hi[axis] : box.lo[axis]).hi;
      if (lo > entry) entry = lo;
      if (hi < exit) exit = hi;
    }
    return entry <= exit;
  }

 private:
  double origin_[3];
  double inverse_lo_[3];
  double inverse_hi_[3];
  double tmin_;
  bool forward_[3];
};

}  // namespace plumb::detail
