#include "raster/triangle_setup.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::detail {
namespace {

constexpr double kU = 0x1p-53;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Vector3 subtract(const glm::vec3& p, const glm::vec3& q) {
  return {double{p.x} - double{q.x}, double{p.y} - double{q.y}, double{p.z} - double{q.z}};
}

// ---- Where on the screen.

struct ScreenBox {
  double x0 = kInfinity, y0 = kInfinity, x1 = -kInfinity, y1 = -kInfinity;
};

// The pixels whose rays can meet the triangle in front of the eye; false when there are none.
//
// A ray that hits it at t > 0 points at a convex combination p of the vertices with row_z.p > 0, at the
// screen point (row_x.p, row_y.p) / row_z.p, which is at most slack_px away from the pixel's centre.
bool bound_on_screen(const Projection& view, const Vector3 corner[3], TriangleSetup& record) {
  record.x0 = record.y0 = 0;
  record.x1 = view.width - 1;
  record.y1 = view.height - 1;
  if (!std::isfinite(view.slack_px)) return true;

  ScreenBox box;
  int in_front = 0, behind = 0, left = 0, right = 0, above = 0, below = 0;
  const double x_low = -view.slack_px, x_high = (view.width - 1) + view.slack_px;
  const double y_low = -view.slack_px, y_high = (view.height - 1) + view.slack_px;
  for (int i = 0; i < 3; ++i) {
    const Vector3& p = corner[i];
    const double size = norm1(p);
    const double px = dot(view.row_x, p), py = dot(view.row_y, p), pz = dot(view.row_z, p);
    const double ex = view.row_error_x * size, ey = view.row_error_y * size, ez = view.row_error_z * size;
    behind += pz < -ez ? 1 : 0;
    // Beyond a side plane: px < x_low pz and so on, for certain, whatever the sign of pz.
    const double wide_x = 1.01 * (ex + (std::fabs(x_high) + 1.0) * (ez + 4.0 * kU * std::fabs(pz)));
    const double wide_y = 1.01 * (ey + (std::fabs(y_high) + 1.0) * (ez + 4.0 * kU * std::fabs(pz)));
    left += px - x_low * pz < -wide_x ? 1 : 0;
    right += px - x_high * pz > wide_x ? 1 : 0;
    above += py - y_low * pz < -wide_y ? 1 : 0;
    below += py - y_high * pz > wide_y ? 1 : 0;
    if (!(pz > 2.0 * ez)) continue;
    ++in_front;
    // (px +- ex) / (pz +- ez) differs from px / pz by less than (ex + |px / pz| ez) / (pz - ez).
    const double x = px / pz, y = py / pz;
    const double x_error = 1.01 * ((ex + std::fabs(x) * ez) / (pz - ez) + 4.0 * kU * std::fabs(x));
    const double y_error = 1.01 * ((ey + std::fabs(y) * ez) / (pz - ez) + 4.0 * kU * std::fabs(y));
    box.x0 = std::min(box.x0, x - x_error);
    box.x1 = std::max(box.x1, x + x_error);
    box.y0 = std::min(box.y0, y - y_error);
    box.y1 = std::max(box.y1, y + y_error);
  }
  if (behind == 3 || left == 3 || right == 3 || above == 3 || below == 3) return false;
  if (in_front < 3) return true;  // across the eye plane: its projection has no bounded box

  // Clamped in double first: the box may lie anywhere. NaN keeps the whole frame.
  const auto clamp = [](double value, double low, double high) {
    return value > low ? std::min(value, high) : low;
  };
  const double x_end = view.width, y_end = view.height;
  const double x0 = std::ceil(box.x0 - view.slack_px), x1 = std::floor(box.x1 + view.slack_px);
  const double y0 = std::ceil(box.y0 - view.slack_px), y1 = std::floor(box.y1 + view.slack_px);
  if (std::isnan(x0 + x1 + y0 + y1)) return true;
  record.x0 = static_cast<std::int32_t>(clamp(x0, 0.0, x_end));
  record.y0 = static_cast<std::int32_t>(clamp(y0, 0.0, y_end));
  record.x1 = static_cast<std::int32_t>(clamp(x1, -1.0, x_end - 1.0));
  record.y1 = static_cast<std::int32_t>(clamp(y1, -1.0, y_end - 1.0));
  return record.x0 <= record.x1 && record.y0 <= record.y1;
}

// ---- The planes.

// n.D over the frame, times `scale`, of which `error` (before scaling) is the bound.
Plane plane_of(const Projection& view, const Vector3& n, double error, double scale) {
  return {dot(n, view.du) * scale, dot(n, view.dv) * scale, dot(n, view.c0) * scale,
          error * std::fabs(scale)};
}

// With p, q the triangle's vertices seen from the eye (each off by u of itself), n = p x q, and the
// edge function E = d.n at a pixel's float ray d:
//   n:       a component by (2 for p and q, 2 for product and difference) 4 u (|p_j q_k| + |p_k q_j|)
//   n.du, n.dv, n.c0: 3 u for the dot product, 3 u for c0; scaling 1 u
//   c + a x + b y at a tile's centre: 3 u
// each times at most G_max |p|_1 |q|_1, so 14 u G_max |p|_1 |q|_1 (20 below, for the second order), and
// for the rounding of the ray: sum of offset_k |n_k|.
Plane edge_plane(const Projection& view, const Vector3& p, const Vector3& q, double turn) {
  const Vector3 n = cross(p, q);
  const double error = 20.0 * kU * view.greatest_max * norm1(p) * norm1(q) + 1.001 * dot_abs(n, view.offset);
  const double slope = std::fabs(dot(n, view.du)) + std::fabs(dot(n, view.dv));
  const double constant = std::fabs(dot(n, view.c0));
  // A slope or constant of 0 or an overflow ends in infinities and NaNs, which every later test takes for
  // "not certain".
  return plane_of(view, n, error, turn / (slope > 0.0 ? slope : constant));
}

// Nothing is known but the box: every pixel in it is decided exactly.
void decide_exactly(TriangleSetup& record) {
  for (Plane& edge : record.edge) edge = {0.0, 0.0, 0.0, kInfinity};
  record.depth = {0.0, 0.0, 0.0, kInfinity};
  record.depth_relative = 0.0;
}

void set_edges(const Projection& view, const Vector3 corner[3], double turn, TriangleSetup& record) {
  for (int i = 0; i < 3; ++i) record.edge[i] = edge_plane(view, corner[i], corner[(i + 1) % 3], turn);
}

}  // namespace

int set_up_triangle(const Projection& view, const glm::vec3& eye, const Triangle& triangle,
                    std::uint32_t index, TriangleSetup records[2]) {
  if (!triangle_is_finite(triangle)) return 0;
  TriangleSetup& record = records[0];
  record.index = index;
  const Vector3 corner[3] = {subtract(triangle.v0, eye), subtract(triangle.v1, eye),
                             subtract(triangle.v2, eye)};
  if (!bound_on_screen(view, corner, record)) return 0;
  if (view.exact_only) {
    decide_exactly(record);
    return 1;
  }

  // The values and bounds of T = N.a and den = N.d are those of exact/intersect.cc's double stage.
  const Vector3 e1 = subtract(triangle.v1, triangle.v0);
  const Vector3 e2 = subtract(triangle.v2, triangle.v0);
  const double extent = std::max(norm1(e1), norm1(e2));
  // Two equal vertices: one edge function is exactly zero, and its displaced sign too.
  if (norm1(e1) == 0.0 || norm1(e2) == 0.0 || triangle.v1 == triangle.v2) return 0;
  const Vector3 n = cross(e1, e2);
  const double t_num = dot(n, corner[0]);
  const double t_num_error = 8.2 * kU * norm_max(corner[0]) * extent * extent;
  const double relative = t_num_error / std::fabs(t_num);
  if (!(relative < 0x1p-10)) {
    // The eye lies in the triangle's plane, or so near that the side it sees is open. Where all three
    // edge functions are positive, or all negative, exact arithmetic decides.
    records[1] = record;
    for (int side = 0; side < 2; ++side) {
      set_edges(view, corner, side == 0 ? 1.0 : -1.0, records[side]);
      records[side].depth = {0.0, 0.0, 0.0, kInfinity};
      records[side].depth_relative = 0.0;
    }
    return 2;
  }

  // Seen in front, t = T / den > 0: the edge functions have den's sign, which is T's.
  set_edges(view, corner, t_num > 0.0 ? 1.0 : -1.0, record);
  // 1/t = den / T. den: 4 u for N, 3 u for the dot product, 3 u for c0, 3 u at the tile's centre, 1 u for
  // the division, each times G_max L^2; and the rounding of the ray.
  const double den_error = 20.0 * kU * view.greatest_max * extent * extent + 1.001 * dot_abs(n, view.offset);
  record.depth = plane_of(view, n, 1.01 * den_error, 1.0 / t_num);
  record.depth_relative = 1.01 * relative + 4.0 * kU;
  return 1;
}

}  // namespace plumb::detail
