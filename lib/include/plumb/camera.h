#pragma once

#include <glm/vec3.hpp>

#include "plumb/ray.h"

namespace plumb {

/// A pinhole camera. Pixel (x, y), rows counted from the top, looks along
///
///     RN32((corner + (x + 0.5) * du) + (y + 0.5) * dv)
///
/// from `eye`, each operation rounded to double and the result to float (docs/visibility.md). The
/// members may be changed; a pixel whose direction is zero or not finite sees nothing.
class Camera {
 public:
  glm::vec3 eye{0.0f, 0.0f, 0.0f};   ///< the origin of every ray
  glm::dvec3 corner{0.0, 0.0, 0.0};  ///< direction to the frame's upper left corner
  glm::dvec3 du{0.0, 0.0, 0.0};      ///< step of the direction to the next pixel of a row
  glm::dvec3 dv{0.0, 0.0, 0.0};      ///< step of the direction to the next row
  int width = 1;                     ///< pixels, at least 1
  int height = 1;                    ///< pixels, at least 1

  /// The camera from its parts. Throws plumb::Error when a size is below 1.
  Camera(glm::vec3 eye, glm::dvec3 corner, glm::dvec3 du, glm::dvec3 dv, int width, int height);

  /// A camera at `eye` that looks at `target`; `up` need not be perpendicular to the view. The
  /// vertical field of view is in degrees, strictly between 0 and 180. Computed as
  /// docs/visibility.md says, bit for bit. Throws plumb::Error for an input that is not finite, a
  /// target equal to the eye, an `up` along the view, a field of view out of range or so small that
  /// its half tangent rounds to 0, and a size below 1.
  static Camera look_at(glm::vec3 eye, glm::vec3 target, glm::vec3 up, double fov_y_degrees, int width,
                        int height);

  /// The ray of pixel (x, y); tmin is 0, tmax infinite. Any ints, outside the frame too.
  Ray ray(int x, int y) const;
};

}  // namespace plumb
