#include "exact/intersect.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/round.h"
#include "exact/axis_plane.h"
#include "exact/determinant.h"
#include "exact/double_stage.h"
#include "exact/expansion.h"
#include "exact/filter_ray.h"

namespace plumb::detail {
namespace {

// What the double stage leaves open is settled by expansions, unconditionally.

// The sign of d.((p - o) x (q - o)) along d + (e, e^2, e^3).
int exact_edge_sign(const glm::vec3& origin, const glm::vec3& direction, const glm::vec3& p,
                    const glm::vec3& q) {
  const ExactNormal n = cross_about(p, q, origin);
  Expansion<36> edge;
  add_dot(edge, n, direction, 1.0);
  if (edge.sign() != 0) return edge.sign();
  if (n.x.sign() != 0) return n.x.sign();
  if (n.y.sign() != 0) return n.y.sign();
  return n.z.sign();
}

bool exactly_covered(const glm::vec3& origin, const glm::vec3& direction, const Triangle& tri) {
  const int sign = exact_edge_sign(origin, direction, tri.v0, tri.v1);
  return sign != 0 && exact_edge_sign(origin, direction, tri.v1, tri.v2) == sign &&
         exact_edge_sign(origin, direction, tri.v2, tri.v0) == sign;
}

// |t| = |num| / |den| against the midpoint of two floats: the sign of |num| - midpoint |den|.
int compare_with_midpoint(const Expansion<72>& num, const Expansion<36>& den, double midpoint) {
  Expansion<144> difference;
  for (int i = 0; i < num.size(); ++i) difference.add(num.sign() * num.part(i));
  difference.add_scaled(den, -den.sign() * midpoint);
  return difference.sign();
}

// The midpoint between a float >= 0 (or infinity) and its neighbour above or below; exact in double.
// Between the greatest float and infinity it is where rounding to infinity begins.
double midpoint_above(float f) {
  const float next = std::nextafter(f, std::numeric_limits<float>::infinity());
  return std::isinf(next) ? 0x1p128 - 0x1p103 : 0.5 * (double{f} + double{next});
}

double midpoint_below(float f) { return midpoint_above(std::nextafter(f, 0.0f)); }

// RN32 of a ratio >= 0 of which `quotient` is within 2^-45 of itself; side(midpoint) is the sign of the ratio
// minus a midpoint of two floats.
template <class Side>
float round_ratio(double quotient, const Side& side_of) {
  // `quotient` rounds to the right float unless a midpoint lies between it and the ratio; then it is the
  // midpoint on its own side of the float.
  const float magnitude = round_to_float(quotient);
  const bool above = quotient >= double{magnitude};
  const double midpoint = above ? midpoint_above(magnitude) : midpoint_below(magnitude);
  if (!(std::fabs(quotient - midpoint) <= 0x1p-45 * midpoint)) return magnitude;
  const int side = side_of(midpoint);
  const float below = above ? magnitude : std::nextafter(magnitude, 0.0f);
  const float next = std::nextafter(below, std::numeric_limits<float>::infinity());
  const bool below_is_even = (std::bit_cast<std::uint32_t>(below) & 1u) == 0;
  return side < 0 || (side == 0 && below_is_even) ? below : next;
}

// The depth in a plane across an axis, N being zero but for that component. False where that cannot be told
// in double.
bool axis_depth(const glm::vec3& origin, const glm::vec3& direction, const Triangle& tri,
                const DoubleStage& stage, float& t) {
  const AxisPlane plane = axis_plane(origin, tri);
  if (plane.axis < 0) return false;
  const double normal[3] = {stage.n.x, stage.n.y, stage.n.z};
  const double along = direction[plane.axis];
  if (!(std::fabs(normal[plane.axis]) > stage.n_error) || along == 0.0) return false;
  const double den_size = std::fabs(along), num_size = std::fabs(plane.distance);
  const float magnitude = round_ratio(num_size / den_size, [&](double midpoint) {
    const double at = midpoint * den_size;  // exact: 25 bits and 24
    return (num_size > at) - (num_size < at);
  });
  t = (plane.distance < 0.0) == (along < 0.0) ? magnitude : -magnitude;
  return true;
}

// RN32(num / den), false for a zero denominator.
bool exact_depth(const glm::vec3& origin, const glm::vec3& direction, const Triangle& tri,
                 const DoubleStage& stage, float& t) {
  if (axis_depth(origin, direction, tri, stage, t)) return true;
  const ExactNormal n = cross_about(tri.v1, tri.v2, tri.v0);
  Expansion<36> den;
  add_dot(den, n, direction, 1.0);
  if (den.sign() == 0) return false;
  Expansion<72> num;
  add_dot(num, n, tri.v0, 1.0);
  add_dot(num, n, origin, -1.0);
  if (num.sign() == 0) {
    t = 0.0f;
    return true;
  }
  // The estimates are good to a few 2^-52.
  const float magnitude = round_ratio(std::fabs(num.estimate() / den.estimate()), [&](double midpoint) {
    return compare_with_midpoint(num, den, midpoint);
  });
  t = num.sign() == den.sign() ? magnitude : -magnitude;
  return true;
}

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

bool triangle_is_finite(const Triangle& triangle) {
  return is_finite(triangle.v0) && is_finite(triangle.v1) && is_finite(triangle.v2);
}

bool line_hit(const glm::vec3& origin, const glm::vec3& direction, const Triangle& triangle, float& t) {
  const DoubleStage stage(origin, direction, triangle);
  if (stage.certainly_missed()) return false;
  if (!stage.certainly_covered() && !exactly_covered(origin, direction, triangle)) return false;
  if (stage.certain_depth(t)) return true;
  return exact_depth(origin, direction, triangle, stage, t) && std::isfinite(t);
}

float line_depth(const glm::vec3& origin, const glm::vec3& direction, const Triangle& triangle) {
  const DoubleStage stage(origin, direction, triangle);
  float t = std::numeric_limits<float>::infinity();
  if (!stage.certain_depth(t)) exact_depth(origin, direction, triangle, stage, t);
  return t;
}

bool ray_hit(const Ray& ray, const Triangle& triangle, bool covered, float limit, float& t) {
  const DoubleStage stage(ray.origin, ray.direction, triangle);
  if (!covered && stage.certainly_missed()) return false;
  // Rounding is monotonic: a t below tmin does not round to more.
  if (stage.certainly_below(std::max(double{ray.tmin}, 0.0)) || stage.certainly_above(double{limit}))
    return false;
  if (!covered && !stage.certainly_covered() && !exactly_covered(ray.origin, ray.direction, triangle))
    return false;
  if (stage.certain_depth(t)) return true;
  return exact_depth(ray.origin, ray.direction, triangle, stage, t) && std::isfinite(t);
}

bool ray_meets(const Ray& ray, const Triangle& triangle, bool covered) {
  const DoubleStage stage(ray.origin, ray.direction, triangle);
  if (!covered && stage.certainly_missed()) return false;
  const float tmin = ray.tmin > 0.0f ? ray.tmin : 0.0f;  // not -0, which depth_limit() does not take
  const double tmax = std::min(double{ray.tmax}, double{std::numeric_limits<float>::max()});
  // What is above the float after tmin rounds to that at least; what is below tmax to no more.
  if (stage.certainly_below(double{tmin}) || stage.certainly_above(double{depth_limit(ray.tmax)}))
    return false;
  if (!covered && !stage.certainly_covered() && !exactly_covered(ray.origin, ray.direction, triangle))
    return false;
  if (stage.certainly_above(double{depth_limit(tmin)}) && stage.certainly_below(tmax)) return true;
  float t = 0.0f;
  if (!stage.certain_depth(t) && !exact_depth(ray.origin, ray.direction, triangle, stage, t)) return false;
  return std::isfinite(t) && depth_counts(ray, t);
}

}  // namespace plumb::detail
