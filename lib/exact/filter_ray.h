#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "plumb/ray.h"

namespace plumb::detail {

/// The least float that no exact value exceeds which rounds to `t` or below: the next float up, which
/// is above the midpoint. Infinity stays. `t` is not negative.
inline float depth_limit(float t) {
  // Floats above 0 are in the order of their bits.
  return t < std::numeric_limits<float>::infinity()
             ? std::bit_cast<float>(std::bit_cast<std::uint32_t>(t) + 1u)
             : t;
}

/// A ray as the float stage takes it (exact/filter-inl.h).
struct FilterRay {
  float origin[3];
  float direction[3];
  float edge_scale;   ///< 9.3 u D: the edge functions' error is at most this times L (2 R + L)
  float den_scale;    ///< 7.2 u D, times L^2
  float depth_scale;  ///< 8.2 u, times R L^2
  /// A hit counts only if its exact t is below this, up to the slack that the float comparison needs.
  float limit;

  /// `greatest` is the greatest |coordinate| of the scene's finite triangles. The limit is infinite.
  FilterRay(const Ray& ray, float greatest)
      : origin{ray.origin.x, ray.origin.y, ray.origin.z},
        direction{ray.direction.x, ray.direction.y, ray.direction.z},
        limit(std::numeric_limits<float>::infinity()) {
    const double d1 =
        std::fabs(double{direction[0]}) + std::fabs(double{direction[1]}) + std::fabs(double{direction[2]});
    const double d_norm = std::max(d1, 0x1p-30);
    // The stage's intermediate values are products of some of D, R, R, L, L or fewer factors; with each
    // factor raised to at least 1, the two below bound them all (L <= 6 greatest, and its clamp).
    const double reach_origin =
        std::max({std::fabs(double{origin[0]}), std::fabs(double{origin[1]}), std::fabs(double{origin[2]})});
    const double d_cap = std::max(d1, 1.0);
    const double r_cap = std::max(reach_origin + greatest, 1.0);
    const double l_cap = std::max(7.0 * double{greatest}, 1.0);
    const bool in_range = d_cap * l_cap * (2.0 * r_cap + l_cap) < 0x1p120 && r_cap * l_cap * l_cap < 0x1p120;
    edge_scale =
        in_range ? static_cast<float>(9.3 * 0x1p-24 * d_norm) : std::numeric_limits<float>::infinity();
    den_scale =
        in_range ? static_cast<float>(7.2 * 0x1p-24 * d_norm) : std::numeric_limits<float>::infinity();
    depth_scale = in_range ? static_cast<float>(8.2 * 0x1p-24) : std::numeric_limits<float>::infinity();
  }

  /// Lowers the limit to what can still win against a hit at `t`, or count below tmax = `t`.
  void set_limit(float t) {
    // Four operations on each side of the comparison, each off by at most 2^-24 of itself.
    limit = depth_limit(t) * (1.0f + 0x1p-20f);
  }
};

}  // namespace plumb::detail
