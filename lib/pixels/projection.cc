#include "pixels/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::detail {
namespace {

constexpr double kU = 0x1p-53;

Vector3 widen(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Vector3 cross(const Vector3& p, const Vector3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

Vector3 negated(const Vector3& p) { return {-p.x, -p.y, -p.z}; }

double dot(const Vector3& p, const Vector3& q) { return (p.x * q.x + p.y * q.y) + p.z * q.z; }

double norm1(const Vector3& p) { return (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z); }

double norm_max(const Vector3& p) { return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}); }

// The sum of |p_k| q_k, for q >= 0: how far p.e can be from 0 when |e_k| <= q_k.
double dot_abs(const Vector3& p, const Vector3& q) {
  return (std::fabs(p.x) * q.x + std::fabs(p.y) * q.y) + std::fabs(p.z) * q.z;
}

// |corner| + |width du| + |height dv| of one component.
double reach(double corner, double du, double dv, int width, int height) {
  return 1.0001 * (std::fabs(corner) + width * std::fabs(du) + height * std::fabs(dv));
}

// The next float above, or so, of a number that is neither huge nor tiny.
float rounded_up(double value) { return static_cast<float>(value * (1.0 + 0x1p-22)); }

FloatRows float_rows(const Projection& view, const glm::vec3& eye) {
  FloatRows rows{};
  const double size_z = norm_max(view.row_z);
  rows.usable = view.slack_px < 1.0 && size_z > 0x1p-900 && size_z < 0x1p900 && view.width < (1 << 20) &&
                view.height < (1 << 20);
  if (!rows.usable) return rows;
  const double scale = std::ldexp(1.0, -std::ilogb(size_z));
  const double ray_depth = scale * view.ray_depth * (1.0 + 0x1p-19);
  const auto ordinary = [](double size) { return size > 0x1p-30 && size < 0x1p30; };
  rows.usable = ordinary(scale * norm_max(view.row_x)) && ordinary(scale * norm_max(view.row_y)) &&
                ray_depth > 0x1p-60 && ray_depth < 0x1p60;
  if (!rows.usable) return rows;
  const auto fill = [&](const Vector3& row, double row_error, float to[3], float& error) {
    to[0] = static_cast<float>(scale * row.x);
    to[1] = static_cast<float>(scale * row.y);
    to[2] = static_cast<float>(scale * row.z);
    error = rounded_up(5.25 * 0x1p-24 * scale * norm_max(row) + 1.001 * scale * row_error);
  };
  for (int axis = 0; axis < 3; ++axis) rows.eye[axis] = eye[axis];
  fill(view.row_x, view.row_error_x, rows.x, rows.error_x);
  fill(view.row_y, view.row_error_y, rows.y, rows.error_y);
  fill(view.row_z, view.row_error_z, rows.z, rows.error_z);
  rows.slack_px = rounded_up(view.slack_px);
  rows.ray_depth = rounded_up(ray_depth);
  return rows;
}

}  // namespace

Projection::Projection(const Camera& camera)
    : eye{camera.eye.x, camera.eye.y, camera.eye.z},
      du(widen(camera.du)),
      dv(widen(camera.dv)),
      width(camera.width),
      height(camera.height) {
  const glm::dvec3& corner = camera.corner;
  c0 = {(corner.x + 0.5 * du.x) + 0.5 * dv.x, (corner.y + 0.5 * du.y) + 0.5 * dv.y,
        (corner.z + 0.5 * du.z) + 0.5 * dv.z};
  const Vector3 most{reach(corner.x, du.x, dv.x, width, height), reach(corner.y, du.y, dv.y, width, height),
                     reach(corner.z, du.z, dv.z, width, height)};
  greatest = norm_max(most);
  // A maximum may drop a NaN, so each component is asked.
  exact_only = !(most.x < 0x1p100 && most.y < 0x1p100 && most.z < 0x1p100 && greatest > 0x1p-100);
  const auto offset_of = [](double g) { return 0x1p-24 * 1.0001 * g + 0x1p-149; };
  offset = {offset_of(most.x), offset_of(most.y), offset_of(most.z)};

  // For p = z (c0 + x du + y dv): (dv x c0).p = z x det, (c0 x du).p = z y det, (du x dv).p = z det with
  // det = c0.(du x dv).
  row_x = cross(dv, c0);
  row_y = cross(c0, du);
  row_z = cross(du, dv);
  double det = dot(c0, row_z);
  if (det < 0.0) {
    row_x = negated(row_x);
    row_y = negated(row_y);
    row_z = negated(row_z);
    det = -det;
  }
  // A component of a row is off by 2 u of the products' magnitudes, 4 u of the lengths' product; row.p by 3
  // times 2 u for the dot product and 2 u more for p, itself off by u of the subtraction that made it. So
  // 12 u of the lengths' product, first order.
  const double step_x = norm_max(du);
  const double step_y = norm_max(dv);
  row_error_x = 20.0 * kU * step_y * greatest;
  row_error_y = 20.0 * kU * step_x * greatest;
  row_error_z = 20.0 * kU * step_x * step_y;

  // A ray d = D(x, y) + e, |e_k| <= offset_k, points at (x det + row_x.e) / (det + row_z.e), so its
  // x is off by at most (|row_x|.offset + |x| |row_z|.offset) / (det - |row_z|.offset). det itself is off
  // by at most 3 (4 + 2 * 3) u times the product of the three lengths.
  const double det_error = 40.0 * kU * step_x * step_y * greatest;
  const auto shift_of = [&](const Vector3& row, double row_error) {
    return 1.01 * (dot_abs(row, offset) + row_error * norm1(offset));
  };
  const double shift_z = shift_of(row_z, row_error_z);
  const double size = std::max(width, height);
  const double shift =
      (std::max(shift_of(row_x, row_error_x), shift_of(row_y, row_error_y)) + size * shift_z) /
      (det - det_error - shift_z);
  const bool usable = !exact_only && det > 4.0 * (det_error + shift_z) && shift < 0.25;
  slack_px = usable ? 1.01 * shift + 1e-9 : std::numeric_limits<double>::infinity();
  ray_depth = 1.0001 * (det + det_error + shift_z);
  rows = float_rows(*this, camera.eye);
}

}  // namespace plumb::detail
