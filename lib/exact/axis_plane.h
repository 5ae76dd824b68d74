#pragma once

#include <glm/vec3.hpp>

#include "exact/intersect.h"

// Planes across an axis: x_axis = c. Their depth is (c - o) / d along the axis alone, so its rounding can be
// told in double, even where it is a midpoint of two floats. Such triangles are common, and their ties are
// too: seen along the axis a whole plane has one t, a quotient of few bits.

namespace plumb::detail {

struct AxisPlane {
  int axis = -1;    ///< none where below 0
  double distance;  ///< c - o exactly, not 0
};

/// The plane that a triangle lies in for certain. None also where c - o is not a double, or is 0.
inline AxisPlane axis_plane(const glm::vec3& origin, const Triangle& tri) {
  for (int axis = 0; axis < 3; ++axis) {
    if (tri.v0[axis] != tri.v1[axis] || tri.v0[axis] != tri.v2[axis]) continue;
    const double plane = tri.v0[axis], from = origin[axis], distance = plane - from;
    // What was rounded does not give back both.
    if (distance == 0.0 || distance + from != plane || plane - distance != from) return {};
    return {axis, distance};
  }
  return {};
}

}  // namespace plumb::detail
