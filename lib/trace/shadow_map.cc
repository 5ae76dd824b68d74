#include "plumb/shadow_map.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include "base/fp_mode.h"
#include "frame/frame_check.h"

namespace plumb {
namespace {

glm::dvec3 cross(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double dot(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Frame cast_light(const Structure& structure, const Camera& light, const CastOptions& options) {
  detail::check_camera(light);
  Frame frame(light.width, light.height);
  cast(structure, light, frame, options);
  return frame;
}

}  // namespace

ShadowMap::ShadowMap(const Structure& structure, const Camera& light, const CastOptions& options)
    : ShadowMap(light, cast_light(structure, light, options)) {}

ShadowMap::ShadowMap(const Camera& light, Frame frame) : light_(light), frame_(std::move(frame)) {
  detail::check_frame(frame_, light_);
  detail::with_default_fp_mode([&] { invert(); });
}

// p = t (corner + u du + v dv), u and v from the frame's upper left corner in pixels. By Cramer's rule
//     t = p.(du x dv) / D    t u = p.(dv x corner) / D    t v = p.(corner x du) / D    D = corner.(du x dv)
// A camera whose directions lie in a plane, D = 0, gives NaN, which lights nothing.
void ShadowMap::invert() {
  const glm::dvec3 across = cross(light_.du, light_.dv);
  const double inverse = 1.0 / dot(light_.corner, across);
  row_z_ = across * inverse;
  row_x_ = cross(light_.dv, light_.corner) * inverse;
  row_y_ = cross(light_.corner, light_.du) * inverse;
}

bool ShadowMap::lit(const glm::vec3& point, float bias) const {
  return detail::with_default_fp_mode([&] {
    const glm::dvec3 seen = glm::dvec3(point) - glm::dvec3(light_.eye);
    const double t = dot(row_z_, seen);
    const double u = dot(row_x_, seen) / t;
    const double v = dot(row_y_, seen) / t;
    // NaN fails each of these.
    if (!(t > 0.0 && u >= 0.0 && u < light_.width && v >= 0.0 && v < light_.height)) return false;
    const std::size_t pixel =
        static_cast<std::size_t>(v) * static_cast<std::size_t>(light_.width) + static_cast<std::size_t>(u);
    return t - double{bias} <= double{frame_.depth[pixel]};
  });
}

}  // namespace plumb
