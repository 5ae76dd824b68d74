#pragma once

#include <glm/vec3.hpp>

#include "base/round.h"
#include "plumb/camera.h"

namespace plumb::detail {

/// The direction of pixel (x, y), as docs/visibility.md defines it. For whoever makes many: the
/// caller holds the default floating-point mode, which Camera::ray sets for each ray anew.
inline glm::vec3 pixel_direction(const Camera& camera, int x, int y) {
  const double column = x + 0.5;
  const double row = y + 0.5;
  const auto component = [column, row](double corner, double du, double dv) {
    return round_to_float((corner + column * du) + row * dv);
  };
  return {component(camera.corner.x, camera.du.x, camera.dv.x),
          component(camera.corner.y, camera.du.y, camera.dv.y),
          component(camera.corner.z, camera.du.z, camera.dv.z)};
}

}  // namespace plumb::detail
