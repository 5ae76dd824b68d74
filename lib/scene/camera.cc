#include "plumb/camera.h"

#include <cmath>
#include <numbers>
#include <sstream>
#include <string>

#include "base/fp_mode.h"
#include "base/round.h"
#include "plumb/error.h"
#include "scene/pixel_direction.h"

// Every operation here decides which triangle a pixel sees, so the order of operations is that of
// docs/visibility.md, written out by component: GLM's own dot, cross and normalize may use another.

namespace plumb {
namespace {

struct Double3 {
  double x, y, z;
};

Double3 widen(const glm::vec3& v) { return {double{v.x}, double{v.y}, double{v.z}}; }

Double3 cross(const Double3& p, const Double3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

// The argument is not zero. Its squares neither overflow nor vanish: a component that is not zero is
// below 2^130 and, a difference of products of a float and a quotient of floats, above 2^-484.
Double3 normalize(const Double3& a) {
  const double length = std::sqrt((a.x * a.x + a.y * a.y) + a.z * a.z);
  return {a.x / length, a.y / length, a.z / length};
}

bool is_zero(const Double3& a) { return a.x == 0.0 && a.y == 0.0 && a.z == 0.0; }

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

std::string text(const glm::vec3& v) {
  std::ostringstream out;
  out.precision(9);
  out << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return out.str();
}

std::string text(double value) {
  std::ostringstream out;
  out.precision(17);
  out << value;
  return out.str();
}

void require_size(int width, int height) {
  if (width >= 1 && height >= 1) return;
  throw Error("plumb: camera of " + std::to_string(width) + " x " + std::to_string(height) +
              " pixels; width and height must be at least 1");
}

void require_finite(const char* name, const glm::vec3& v) {
  if (is_finite(v)) return;
  throw Error("plumb: the camera's " + std::string(name) + " is " + text(v) +
              "; all its coordinates must be finite");
}

// RN32(tan(half the field of view)).
double half_height(double fov_y_degrees) {
  if (!(fov_y_degrees > 0.0 && fov_y_degrees < 180.0)) {
    throw Error("plumb: the camera's vertical field of view is " + text(fov_y_degrees) +
                " degrees; it must lie strictly between 0 and 180");
  }
  const double hh = double{detail::round_to_float(std::tan(fov_y_degrees * (std::numbers::pi / 360.0)))};
  if (hh == 0.0) {
    throw Error("plumb: the camera's vertical field of view, " + text(fov_y_degrees) +
                " degrees, is too small: its half tangent rounds to 0 as a float");
  }
  return hh;
}

[[gnu::noinline]] Camera make_look_at(const glm::vec3& eye, const glm::vec3& target, const glm::vec3& up,
                                      double fov_y_degrees, int width, int height) {
  require_size(width, height);
  require_finite("eye", eye);
  require_finite("target", target);
  require_finite("up vector", up);
  const double hh = half_height(fov_y_degrees);
  const Double3 from = widen(eye), to = widen(target);
  const Double3 view{to.x - from.x, to.y - from.y, to.z - from.z};
  if (is_zero(view)) {
    throw Error("plumb: the camera's target equals its eye, " + text(eye) + "; move one of them");
  }
  const Double3 f = normalize(view);
  const Double3 side = cross(f, widen(up));
  if (is_zero(side)) {
    throw Error("plumb: the camera's up vector " + text(up) +
                " is zero or along the view; choose one that points to another side");
  }
  const Double3 r = normalize(side);
  const Double3 u = cross(r, f);
  const double hw = (hh * width) / height;
  const double step_x = (2.0 * hw) / width;
  const double step_y = (2.0 * hh) / height;
  const glm::dvec3 corner((f.x - r.x * hw) + u.x * hh, (f.y - r.y * hw) + u.y * hh,
                          (f.z - r.z * hw) + u.z * hh);
  const glm::dvec3 du(r.x * step_x, r.y * step_x, r.z * step_x);
  const glm::dvec3 dv(-(u.x * step_y), -(u.y * step_y), -(u.z * step_y));
  return Camera(eye, corner, du, dv, width, height);
}

}  // namespace

Camera::Camera(glm::vec3 eye_in, glm::dvec3 corner_in, glm::dvec3 du_in, glm::dvec3 dv_in, int width_in,
               int height_in)
    : eye(eye_in), corner(corner_in), du(du_in), dv(dv_in), width(width_in), height(height_in) {
  require_size(width, height);
}

Camera Camera::look_at(glm::vec3 eye, glm::vec3 target, glm::vec3 up, double fov_y_degrees, int width,
                       int height) {
  return detail::with_default_fp_mode(
      [&] { return make_look_at(eye, target, up, fov_y_degrees, width, height); });
}

Ray Camera::ray(int x, int y) const {
  Ray ray;
  ray.origin = eye;
  ray.direction = detail::with_default_fp_mode([&] { return detail::pixel_direction(*this, x, y); });
  return ray;
}

}  // namespace plumb
