#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/vec3.hpp>

#include "base/round.h"
#include "exact/intersect.h"

namespace plumb::detail {

struct Double3 {
  double x, y, z;
};

inline Double3 subtract(const glm::vec3& p, const glm::vec3& q) {
  return {double{p.x} - double{q.x}, double{p.y} - double{q.y}, double{p.z} - double{q.z}};
}

inline Double3 cross(const Double3& p, const Double3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

inline double dot(const Double3& p, const Double3& q) { return (p.x * q.x + p.y * q.y) + p.z * q.z; }

inline double norm1(const Double3& p) { return (std::fabs(p.x) + std::fabs(p.y)) + std::fabs(p.z); }

inline double norm_max(const Double3& p) {
  return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

// The edge functions and the two determinants of the depth in double, with proven bounds.
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
inline constexpr double kU = 0x1p-53;

struct DoubleStage {
  double edge0, edge1, edge2;
  double e_min, e_max;  // least and greatest of the edge functions
  double e_error;       // of each of them
  Double3 n;            // e1 x e2
  double n_error;       // of each component
  double den, den_error;
  double t_num, t_num_error;

  DoubleStage(const glm::vec3& origin, const glm::vec3& direction, const Triangle& tri) {
    const Double3 d{direction.x, direction.y, direction.z};
    const Double3 a = subtract(tri.v0, origin);
    const Double3 e1 = subtract(tri.v1, tri.v0);
    const Double3 e2 = subtract(tri.v2, tri.v0);
    const Double3 m = cross(d, a);
    n = cross(e1, e2);
    edge0 = dot(e1, m);
    edge2 = -dot(e2, m);
    den = dot(n, d);
    edge1 = (den - edge0) - edge2;
    t_num = dot(n, a);
    e_min = std::min({edge0, edge1, edge2});
    e_max = std::max({edge0, edge1, edge2});
    const double dd = norm1(d);
    const double rr = norm_max(a);
    const double ll = std::max(norm1(e1), norm1(e2));
    e_error = 9.2 * kU * dd * ll * (2.0 * rr + ll);
    n_error = 4.1 * kU * ll * ll;
    den_error = 7.1 * kU * dd * ll * ll;
    t_num_error = 8.1 * kU * rr * ll * ll;
  }

  bool certainly_covered() const { return e_min > e_error || e_max < -e_error; }
  bool certainly_missed() const { return e_min < -e_error && e_max > e_error; }

  // Whether t = T / den is below x, or above, for certain; x is not negative. T and den are within their
  // errors of what was computed, and 2^-50 makes up for the four roundings of a comparison. Nothing
  // overflows: the products are below 2^128 2^520.
  bool certainly_below(double x) const {
    return std::fabs(den) > den_error &&
           along() + t_num_error < x * (std::fabs(den) - den_error) * (1.0 - 0x1p-50);
  }
  bool certainly_above(double x) const {
    return std::fabs(den) > den_error &&
           along() - t_num_error > x * (std::fabs(den) + den_error) * (1.0 + 0x1p-50);
  }

  // The quotient of the computed values, and how many units of its last place it may be off from
  // det(a, b, c) / den: a relative (t_num_error / |t_num| + den_error / |den|), up to second order, and u
  // for the division; 2^53 times as much in units of the last place.
  double depth_quotient(double& error_ulps) const {
    error_ulps = 0x1p53 * 1.02 * (t_num_error / std::fabs(t_num) + den_error / std::fabs(den)) + 3.0;
    return t_num / den;
  }

  // RN32(t_num / den) where every quotient within the bounds rounds to it.
  //
  // The quotient's last 29 bits are what the rounding to float drops; the rounding is certain when they are
  // further than the error from 2^28, the midpoint of two floats. The error must also be small
  // against a quarter of a float's last place, lest it reach across a power of two, where floats
  // lie twice as close.
  //
  // Error and distance are compared without another division, times |t_num den|, whose factors are asked to
  // be so large and small that nothing underflows or overflows.
  bool certain_depth(float& t) const {
    const double q = t_num / den;
    const double magnitude = std::fabs(q);
    const double num_size = std::fabs(t_num), den_size = std::fabs(den);
    if (!(magnitude > 0x1p-125 && magnitude < 0x1p127 && num_size > 0x1p-400 && num_size < 0x1p400 &&
          den_size > 0x1p-400 && den_size < 0x1p400))
      return false;
    const double product = num_size * den_size;
    const double error = (0x1p53 * 1.03) * (t_num_error * den_size + den_error * num_size);
    const auto low = static_cast<std::int64_t>(std::bit_cast<std::uint64_t>(q) & 0x1fffffffu);
    const auto distance = static_cast<double>(std::abs(low - 0x10000000)) - 3.0;
    if (!(error < 0x1p26 * product && error < distance * product)) return false;
    t = round_to_float(q);
    return true;
  }

 private:
  double along() const { return den < 0.0 ? -t_num : t_num; }
};

}  // namespace plumb::detail
