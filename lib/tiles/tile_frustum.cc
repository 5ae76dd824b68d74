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

struct Interval {
  double lo, hi;
};

// Of one component of the directions of a rectangle's pixels: it is affine but for `offset`, which has room
// for the roundings here (pixels/projection.h: theirs are 2^-49 of what 2^-24 1e-4 is left of).
Interval extremes(double c0, double du, double dv, double offset, int x0, int y0, int x1, int y1) {
  const auto [x_lo, x_hi] = std::minmax({x0 * du, x1 * du});
  const auto [y_lo, y_hi] = std::minmax({y0 * dv, y1 * dv});
  return {(c0 + x_lo) + y_lo - offset, (c0 + x_hi) + y_hi + offset};
}

TileSlab make_slab(const Interval& direction, float eye, std::uint32_t axis) {
  // Above this no scale overflows.
  constexpr double kLeast = 0x1p-100;
  const bool up = direction.lo > 0.0;
  const double sign = up ? 1.0 : -1.0;
  const double least = up ? direction.lo : -direction.hi;
  const double greatest = up ? direction.hi : -direction.lo;
  TileSlab slab{eye,
                0.0f,
                0.0f,
                std::numeric_limits<float>::infinity(),
                2 * axis + (up ? 0u : 1u),
                2 * axis + (up ? 1u : 0u)};
  if (!(least > 0.0)) return slab;  // of either sign
  if (greatest > kLeast) slab.near_scale = round_to_float(sign / greatest * (1.0 - 0x1p-21));
  if (least > kLeast) {
    slab.far_scale = round_to_float(sign / least * (1.0 + 0x1p-21));
    slab.far_room = kSlabRoom;
  }
  return slab;
}

}  // namespace

FrameFrustum::FrameFrustum(const Projection& view_in, float greatest)
    : view(view_in),
      reach(double{greatest} +
            std::max({std::fabs(view.eye.x), std::fabs(view.eye.y), std::fabs(view.eye.z)})),
      usable(view.slack_px < std::numeric_limits<double>::infinity() && reach < 0x1p60),
      depth(make_plane(*this, view.row_z, view.row_error_z, -1.0)),
      // The least of 1 / row_z.d over the rays, with row_z's own size for z's. 2^-20 is 16 u: 1 u for this
      // and the product each, the rest to spare. Where z is tiny the product might underflow: then to below
      // 2^-90.
      depth_scale(round_to_float(norm1(view.row_z) / view.ray_depth * (1.0 - 0x1p-20))) {}

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
  const auto slab_of = [&](double c0, double du, double dv, double offset, float eye, std::uint32_t axis) {
    return make_slab(extremes(c0, du, dv, offset, x0, y0, x1, y1), eye, axis);
  };
  slab[0] = slab_of(view.c0.x, view.du.x, view.dv.x, view.offset.x, static_cast<float>(view.eye.x), 0);
  slab[1] = slab_of(view.c0.y, view.du.y, view.dv.y, view.offset.y, static_cast<float>(view.eye.y), 1);
  slab[2] = slab_of(view.c0.z, view.du.z, view.dv.z, view.offset.z, static_cast<float>(view.eye.z), 2);
}

}  // namespace plumb::detail
