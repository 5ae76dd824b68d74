#include <cmath>

#include "oracle/exact.h"
#include "oracle/oracle.h"

// Plain double arithmetic, which rounds each operation as the definition asks on any machine with
// IEEE doubles; the build sees to it that nothing is contracted. RN32 is done in integers.

namespace oracle {
namespace {

DVec3 cross(const DVec3& p, const DVec3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

DVec3 normalize(const DVec3& a) {
  const double length = std::sqrt((a.x * a.x + a.y * a.y) + a.z * a.z);
  return {a.x / length, a.y / length, a.z / length};
}

DVec3 operator*(const DVec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
DVec3 operator+(const DVec3& a, const DVec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
DVec3 operator-(const DVec3& a, const DVec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
DVec3 operator-(const DVec3& a) { return {-a.x, -a.y, -a.z}; }

DVec3 widen(const Vec3& v) { return {double{v.x}, double{v.y}, double{v.z}}; }

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }
bool is_zero(const DVec3& v) { return v.x == 0.0 && v.y == 0.0 && v.z == 0.0; }

}  // namespace

Ray Camera::ray(int x, int y) const {
  const DVec3 direction = (corner + du * (x + 0.5)) + dv * (y + 0.5);
  return {eye,
          0.0f,
          {nearest_float(direction.x), nearest_float(direction.y), nearest_float(direction.z)},
          std::numeric_limits<float>::infinity()};
}

std::optional<Camera> look_at(const Vec3& eye, const Vec3& target, const Vec3& up, double fov_y_degrees,
                              int width, int height) {
  if (!is_finite(eye) || !is_finite(target) || !is_finite(up) || !std::isfinite(fov_y_degrees)) return {};
  if (!(fov_y_degrees > 0.0 && fov_y_degrees < 180.0) || width < 1 || height < 1) return {};
  const DVec3 view = widen(target) - widen(eye);
  if (is_zero(view)) return {};
  const DVec3 f = normalize(view);
  const DVec3 side = cross(f, widen(up));
  if (is_zero(side)) return {};
  const DVec3 r = normalize(side);
  const DVec3 u = cross(r, f);
  constexpr double kPi = 0x1.921fb54442d18p+1;
  const double hh = double{nearest_float(std::tan(fov_y_degrees * (kPi / 360.0)))};
  if (hh == 0.0) return {};
  const double hw = (hh * width) / height;
  const DVec3 du = r * ((2.0 * hw) / width);
  const DVec3 dv = -(u * ((2.0 * hh) / height));
  const DVec3 corner = (f - r * hw) + u * hh;
  return Camera{eye, corner, du, dv, width, height};
}

}  // namespace oracle
