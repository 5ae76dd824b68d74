#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "build/binary_tree.h"

namespace plumb::detail {

/// The box of nothing: growing it by another box gives that box.
inline Box empty_box() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  return {glm::vec3(kInfinity), glm::vec3(-kInfinity)};
}

/// Half the surface area, in double: the extents of float boxes may overflow float. Zero for an empty
/// box.
inline double half_area(const Box& box) {
  const double x = double{box.hi.x} - double{box.lo.x};
  const double y = double{box.hi.y} - double{box.lo.y};
  const double z = double{box.hi.z} - double{box.lo.z};
  return x < 0.0 ? 0.0 : (x * y + y * z) + z * x;
}

/// The greatest |coordinate|; 0 for an empty box.
inline float greatest_coordinate(const Box& box) {
  if (box.lo.x > box.hi.x) return 0.0f;
  float greatest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    greatest = std::max({greatest, std::fabs(box.lo[axis]), std::fabs(box.hi[axis])});
  }
  return greatest;
}

}  // namespace plumb::detail
