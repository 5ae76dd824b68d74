#include "tiles/tile_frustum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/round.h"

namespace plumb::detail {
namespace {

constexpr double kFloatU = 0x1p-24;
constexpr double kU = 0x1p-53;

double norm1(const Vector3& p) { return (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z); }

// row - x row_z
Vector3 through(const Vector3& row, double x, const Vector3& row_z) {
  return {row.x - x * row_z.x, row.y - x * row_z.y, row.z - x * row_z.z};
}

Vector3 negated(const Vector3& p) { return {-p.x, -p.y, -p.z}; }

// The plane of N through the eye, moved by `sign` times its room. `error` bounds |N.p computed in double -
// exact| / |p|_1.
BoxPlane make_plane(const FrameFrustum& frame, const Vector3& N, double error, double sign) {
  const Vector3& eye = frame.view.eye;
  const double size = norm1(N);
  const double n[3] = {N.x / size, N.y / size, N.z / size};
  // |p|_1 <= 3 R; a few u more for the division and the sum of the offset.
  const double room = frame.reach * (8.0 * kFloatU + 3.0 * (error / size) + 16.0 * kU) + 0x1p-120;
  BoxPlane plane;
  plane.offset = round_to_float(sign * room - ((n[0] * eye.x + n[1] * eye.y) + n[2] * eye.z));
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    plane.normal[axis] = round_to_float(n[axis]);
    const std::uint32_t up = n[axis] > 0.0 ? 1 : 0;
    plane.greatest_row[axis] = 2 * axis + up;
    plane.least_row[axis] = 2 * axis + (1 - up);
  }
  return plane;
}

}  // namespace

FrameFrustum::FrameFrustum(const Projection& view_in, float greatest)
    : view(view_in),
      reach(double{greatest} +
            std::max({std::fabs(view.eye.x), std::fabs(view.eye.y), std::fabs(view.eye.z)})),
      usable(view.slack_px < std::numeric_limits<double>::infinity() && reach < 0x1p60),
      depth(make_plane(*this, view.row_z, view.row_error_z, -1.0)),
      // The greatest row_z.d of a ray over row_z's own size. 2^-20 is 16 u: 2 u for this, 2 u for the product
      // with z, the rest as in pixels/screen_bounds-inl.h. Where it is small that product might underflow.
      depth_scale(round_to_float(std::max(view.ray_depth / norm1(view.row_z) * (1.0 + 0x1p-20), 0x1p-90))) {}

TileFrustum::TileFrustum(const FrameFrustum& frame, int x0, int y0, int x1, int y1) {
  const Projection& view = frame.view;
  // A hit's point p has row_z.p > 0 and row_x.p / row_z.p from x0 - slack to x1 + slack
  // (pixels/projection.h).
  const auto plane = [&](const Vector3& row, double row_error, double x, bool low) {
    const Vector3 normal = through(row, x, view.row_z);
    const double error = (row_error + std::fabs(x) * view.row_error_z) +
                         4.0 * kU * (norm1(row) + std::fabs(x) * norm1(view.row_z));
    return make_plane(frame, low ? normal : negated(normal), error, 1.0);
  };
  side[0] = plane(view.row_x, view.row_error_x, x0 - view.slack_px, true);
  side[1] = plane(view.row_x, view.row_error_x, x1 + view.slack_px, false);
  side[2] = plane(view.row_y, view.row_error_y, y0 - view.slack_px, true);
  side[3] = plane(view.row_y, view.row_error_y, y1 + view.slack_px, false);
}

}  // namespace plumb::detail
