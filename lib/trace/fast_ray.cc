#include "trace/fast_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::detail {

FastRay::FastRay(const Ray& ray)
    : origin{ray.origin.x, ray.origin.y, ray.origin.z},
      direction{ray.direction.x, ray.direction.y, ray.direction.z},
      tmin(ray.tmin > 0.0f ? ray.tmin : 0.0f) {
  constexpr float kGreatest = std::numeric_limits<float>::max();
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const bool forward = !std::signbit(direction[axis]);
    inverse[axis] = std::clamp(1.0f / direction[axis], -kGreatest, kGreatest);
    near_row[axis] = 2 * axis + (forward ? 0 : 1);
    far_row[axis] = 2 * axis + (forward ? 1 : 0);
  }
}

}  // namespace plumb::detail
