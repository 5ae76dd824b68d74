#include "raster/projection.h"

#include <cmath>
#include <limits>

namespace plumb::detail {
namespace {

constexpr double kU = 0x1p-53;

Vector3 widen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// |c| + |width du| + |height dv| of one component.
double reach(double corner, double du, double dv, int width, int height) {
  return 1.0001 * (std::fabs(corner) + width * std::fabs(du) + height * std::fabs(dv));
}

}  // namespace

Projection::Projection(const Camera& camera)
    : du(widen(camera.du)), dv(widen(camera.dv)), width(camera.width), height(camera.height) {
  const glm::dvec3& corner = camera.corner;
  c0 = {(corner.x + 0.5 * du.x) + 0.5 * dv.x, (corner.y + 0.5 * du.y) + 0.5 * dv.y,
        (corner.z + 0.5 * du.z) + 0.5 * dv.z};
  greatest = {reach(corner.x, du.x, dv.x, width, height), reach(corner.y, du.y, dv.y, width, height),
              reach(corner.z, du.z, dv.z, width, height)};
  greatest_max = norm_max(greatest);
  // fmax drops a NaN, so each component is asked.
  exact_only =
      !(greatest.x < 0x1p100 && greatest.y < 0x1p100 && greatest.z < 0x1p100 && greatest_max > 0x1p-100);
  const auto offset_of = [](double g) { return 0x1p-24 * 1.0001 * g + 0x1p-149; };
  offset = {offset_of(greatest.x), offset_of(greatest.y), offset_of(greatest.z)};

  // For p = z (c0 + x du + y dv): (dv x c0).p = z x det, (c0 x du).p = z y det, (du x dv).p = z det with
  // det = c0.(du x dv).
  row_x = cross(dv, c0);
  row_y = cross(c0, du);
  row_z = cross(du, dv);
  const double det = dot(c0, row_z);
  if (det < 0.0) {
    row_x = {-row_x.x, -row_x.y, -row_x.z};
    row_y = {-row_y.x, -row_y.y, -row_y.z};
    row_z = {-row_z.x, -row_z.y, -row_z.z};
  }
  // A component of a row: 2 u of the products' magnitudes, 3 u more for c0's rounding (c0 <= G); the dot
  // product with p, itself off by u of the subtraction that made it: 4 u. So 9 u, first order.
  const double step_x = norm_max(du);
  const double step_y = norm_max(dv);
  row_error_x = 10.0 * kU * 2.0 * step_y * greatest_max;
  row_error_y = 10.0 * kU * 2.0 * step_x * greatest_max;
  row_error_z = 10.0 * kU * 2.0 * step_x * step_y;

  // A ray d = D(x, y) + e, |e_k| <= offset_k, points at (x det + row_x.e) / (det + row_z.e), so its
  // x is off by at most (|row_x|.offset + |x| |row_z|.offset) / (det - |row_z|.offset). det itself is off
  // by at most 12 u times the product of the three lengths.
  const double det_magnitude = std::fabs(det);
  const double det_error = 40.0 * kU * step_x * step_y * greatest_max;
  const auto shift_of = [&](const Vector3& row, double row_error) {
    return 1.01 * (dot_abs(row, offset) + row_error * norm1(offset));
  };
  const double shift_z = shift_of(row_z, row_error_z);
  const double size = std::fmax(width, height);
  const double shift =
      (std::fmax(shift_of(row_x, row_error_x), shift_of(row_y, row_error_y)) + size * shift_z) /
      (det_magnitude - det_error - shift_z);
  const bool usable = !exact_only && det_magnitude > 4.0 * (det_error + shift_z) && shift < 0.25;
  slack_px = usable ? 1.01 * shift + 1e-9 : std::numeric_limits<double>::infinity();
}

}  // namespace plumb::detail
