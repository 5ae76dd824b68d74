#include "exact/intersect.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/round.h"
#include "exact/expansion.h"

namespace plumb::detail {
namespace {

struct Double3 {
  double x, y, z;
};

Double3 subtract(const glm::vec3& p, const glm::vec3& q) {
  return {double{p.x} - double{q.x}, double{p.y} - double{q.y}, double{p.z} - double{q.z}};
}

Double3 cross(const Double3& p, const Double3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

double dot(const Double3& p, const Double3& q) { return (p.x * q.x + p.y * q.y) + p.z * q.z; }

double norm1(const Double3& p) { return (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z); }

double norm_max(const Double3& p) { return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)}); }

// ---- Stage one: double with a proven bound.
//
// With a = v0 - o, e1 = v1 - v0, e2 = v2 - v0 (so b = a + e1, c = a + e2), m = d x a, N = e1 x e2:
//
//     E0 = d.(a x b) = e1.m     E2 = d.(c x a) = -e2.m     E0 + E1 + E2 = N.d     det(a, b, c) = N.a
//
// The errors, for u = 2^-53, D = |d|_1, R = |a|_max, L = max(|e1|_1, |e2|_1) as computed. A rounded
// difference is off by u of itself. Then, to first order,
//   m:  a component is off by (1 for a, 1 for the product, 1 for the difference) 3 u R (|d_j| + |d_k|)
//   E0: sum |e1_i| R (D - |d_i|) * (3 for m, 1 for e1, 3 for product and two sums) <= 7 u D R L
//   N:  a component by (2 for e1 and e2, 2 for product and difference) 4 u (|e1_j e2_k| + |e1_k e2_j|)
//   den = N.d: (4 for N, 3 for the dot product) 7 u |d|_max sum over j != k of |e1_j e2_k| <= 7 u D L^2
//   T = N.a:   (4 for N, 1 for a, 3) 8 u R L^2
//   E1 = den - E0 - E2: 7 u D L^2 + 14 u D R L + u (D L^2 + D R L) + u (D L^2 + 2 D R L)
//        = u D L (9 L + 17 R)
// so that 9 u D L (2 R + L) bounds all three edge functions. The constants below leave 1 % and more
// for second-order terms and for the rounding of D, R, L and of the bound itself. Nothing overflows
// (D, R, L < 2^131) and what underflows is below 2^-1022, while a bound that is not 0 is a product
// above 2^-53 * 2^-149 * 2^-149 * 2^-149. When a bound is 0, a factor D, R or L is 0 and the values
// computed are exactly 0 as well, so nothing is called certain.
constexpr double kU = 0x1p-53;

struct DoubleStage {
  double e_min, e_max;  // least and greatest of the edge functions
  double e_error;
  double den, den_error;
  double t_num, t_num_error;

  DoubleStage(const glm::vec3& origin, const glm::vec3& direction, const Triangle& tri) {
    const Double3 d{direction.x, direction.y, direction.z};
    const Double3 a = subtract(tri.v0, origin);
    const Double3 e1 = subtract(tri.v1, tri.v0);
    const Double3 e2 = subtract(tri.v2, tri.v0);
    const Double3 m = cross(d, a);
    const Double3 n = cross(e1, e2);
    const double edge0 = dot(e1, m);
    const double edge2 = -dot(e2, m);
    den = dot(n, d);
    const double edge1 = (den - edge0) - edge2;
    t_num = dot(n, a);
    e_min = std::min({edge0, edge1, edge2});
    e_max = std::max({edge0, edge1, edge2});
    const double dd = norm1(d);
    const double rr = norm_max(a);
    const double ll = std::max(norm1(e1), norm1(e2));
    e_error = 9.2 * kU * dd * ll * (2.0 * rr + ll);
    den_error = 7.1 * kU * dd * ll * ll;
    t_num_error = 8.1 * kU * rr * ll * ll;
  }

  bool certainly_covered() const { return e_min > e_error || e_max < -e_error; }
  bool certainly_missed() const { return e_min < -e_error && e_max > e_error; }

  // RN32(t_num / den) where every quotient within the bounds rounds to it.
  //
  // The quotient q of the computed values is off by a relative (t_num_error / |t_num| + den_error /
  // |den|), up to second order, and by u for the division. In units of q's last place that is at most
  // 2^53 times as much. q's last 29 bits are what the rounding to float drops; the rounding is certain when
  // they are further than that from 2^28, the midpoint of two floats. The error must also be small
  // against a quarter of a float's last place, lest it reach across a power of two, where floats
  // lie twice as close.
  bool certain_depth(float& t) const {
    const double q = t_num / den;
    const double magnitude = std::fabs(q);
    if (!(magnitude > 0x1p-125 && magnitude < 0x1p127)) return false;
    const double error_ulps =
        0x1p53 * 1.02 * (t_num_error / std::fabs(t_num) + den_error / std::fabs(den)) + 3.0;
    if (!(error_ulps < 0x1p26)) return false;
    const auto low = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(q) & 0x1fffffffu);
    const auto distance = static_cast<double>(std::abs(low - 0x10000000));
    if (!(distance > error_ulps)) return false;
    t = round_to_float(q);
    return true;
  }
};

// ---- Stage two: expansions, unconditional.

using Component = Expansion<6>;
struct Normal {
  Component x, y, z;
};

void add_cross(Normal& n, const glm::vec3& p, const glm::vec3& q) {
  // A product of two floats is exact in double.
  const Double3 a{p.x, p.y, p.z};
  const Double3 b{q.x, q.y, q.z};
  n.x.add(a.y * b.z);
  n.x.add(-(a.z * b.y));
  n.y.add(a.z * b.x);
  n.y.add(-(a.x * b.z));
  n.z.add(a.x * b.y);
  n.z.add(-(a.y * b.x));
}

// (p - r) x (q - r) = p x q + q x r + r x p
Normal cross_about(const glm::vec3& p, const glm::vec3& q, const glm::vec3& r) {
  Normal n;
  add_cross(n, p, q);
  add_cross(n, q, r);
  add_cross(n, r, p);
  return n;
}

template <int Capacity>
void add_dot(Expansion<Capacity>& sum, const Normal& n, const glm::vec3& p, double factor) {
  // The factor is 1 or -1, so this is exact.
  sum.add_scaled(n.x, factor * double{p.x});
  sum.add_scaled(n.y, factor * double{p.y});
  sum.add_scaled(n.z, factor * double{p.z});
}

// The sign of d.((p - o) x (q - o)) along d + (e, e^2, e^3).
int exact_edge_sign(const glm::vec3& origin, const glm::vec3& direction, const glm::vec3& p,
                    const glm::vec3& q) {
  const Normal n = cross_about(p, q, origin);
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

// RN32(num / den), false for a zero denominator.
bool exact_depth(const glm::vec3& origin, const glm::vec3& direction, const Triangle& tri, float& t) {
  const Normal n = cross_about(tri.v1, tri.v2, tri.v0);
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
  // The estimates are good to a few 2^-52, so `quotient` rounds to the right float unless a midpoint
  // lies between it and the true ratio; then it is the midpoint on its own side of the float.
  const double quotient = std::fabs(num.estimate() / den.estimate());
  float magnitude = round_to_float(quotient);
  const bool above = quotient >= double{magnitude};
  const double midpoint = above ? midpoint_above(magnitude) : midpoint_below(magnitude);
  if (std::fabs(quotient - midpoint) <= 0x1p-45 * midpoint) {
    const int side = compare_with_midpoint(num, den, midpoint);
    const float below = above ? magnitude : std::nextafter(magnitude, 0.0f);
    const float next = std::nextafter(below, std::numeric_limits<float>::infinity());
    const bool below_is_even = (std::bit_cast<std::uint32_t>(below) & 1u) == 0;
    magnitude = side < 0 || (side == 0 && below_is_even) ? below : next;
  }
  t = num.sign() == den.sign() ? magnitude : -magnitude;
  return true;
}

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

bool ray_is_valid(const Ray& ray) {
  const glm::vec3& d = ray.direction;
  return is_finite(ray.origin) && is_finite(d) && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f) &&
         !std::isnan(ray.tmin) && !std::isnan(ray.tmax);
}

bool triangle_is_finite(const Triangle& triangle) {
  return is_finite(triangle.v0) && is_finite(triangle.v1) && is_finite(triangle.v2);
}

bool line_hit(const glm::vec3& origin, const glm::vec3& direction, const Triangle& triangle, float& t) {
  const DoubleStage stage(origin, direction, triangle);
  if (stage.certainly_missed()) return false;
  if (!stage.certainly_covered() && !exactly_covered(origin, direction, triangle)) return false;
  if (stage.certain_depth(t)) return true;
  return exact_depth(origin, direction, triangle, t) && std::isfinite(t);
}

float line_depth(const glm::vec3& origin, const glm::vec3& direction, const Triangle& triangle) {
  const DoubleStage stage(origin, direction, triangle);
  float t = std::numeric_limits<float>::infinity();
  if (!stage.certain_depth(t)) exact_depth(origin, direction, triangle, t);
  return t;
}

}  // namespace plumb::detail
