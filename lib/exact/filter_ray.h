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

  static constexpr float kEdgeScale = 9.3f * 0x1p-24f;
  static constexpr float kDenScale = 7.2f * 0x1p-24f;
  static constexpr float kDepthScale = 8.2f * 0x1p-24f;
  /// The least D of the bounds.
  static constexpr float kLeastDirection = 0x1p-30f;
  /// The stage is in range where D, the origin's and the scene's coordinates are all below these, as they
  /// mostly are.
  static constexpr float kPlainDirection = 0x1p20f;
  static constexpr float kPlainCoordinate = 0x1p35f;

  /// `greatest` is the greatest |coordinate| of the scene's finite triangles. The limit is infinite.
  FilterRay(const Ray& ray, float greatest)
      : origin{ray.origin.x, ray.origin.y, ray.origin.z},
        direction{ray.direction.x, ray.direction.y, ray.direction.z},
        limit(std::numeric_limits<float>::infinity()) {
    // Two sums round; the constants' slack is a hundred thousand times that.
    const float d_norm = (std::fabs(direction[0]) + std::fabs(direction[1])) + std::fabs(direction[2]);
    const float reach = std::max({std::fabs(origin[0]), std::fabs(origin[1]), std::fabs(origin[2])});
    if (!in_range(d_norm, reach, greatest)) {
      edge_scale = den_scale = depth_scale = std::numeric_limits<float>::infinity();
      return;
    }
    edge_scale = kEdgeScale * std::max(d_norm, kLeastDirection);
    den_scale = kDenScale * std::max(d_norm, kLeastDirection);
    depth_scale = kDepthScale;
  }

  /// Lowers the limit to what can still win against a hit at `t`, or count below tmax = `t`.
  void set_limit(float t) {
    // Four operations on each side of the comparison, each off by at most 2^-24 of itself.
    limit = depth_limit(t) * (1.0f + 0x1p-20f);
  }

 private:
  // Whether no intermediate value of the stage can exceed 2^120. They are products of some of D, R, R, L, L
  // or fewer factors; with each factor raised to at least 1, the two below bound them all (L <= 6 greatest,
  // and its clamp).
  static bool in_range(float d_norm, float reach, float greatest) {
    if (d_norm < kPlainDirection && reach < kPlainCoordinate && greatest < kPlainCoordinate) [[likely]] {
      return true;
    }
    const double d_cap = std::max(double{d_norm}, 1.0);
    const double r_cap = std::max(double{reach} + double{greatest}, 1.0);
    const double l_cap = std::max(7.0 * double{greatest}, 1.0);
    return d_cap * l_cap * (2.0 * r_cap + l_cap) < 0x1p120 && r_cap * l_cap * l_cap < 0x1p120;
  }
};

}  // namespace plumb::detail
