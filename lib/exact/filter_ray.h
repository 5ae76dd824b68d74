#pragma once

#include <bit>
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
  FilterRay(const Ray& ray, float greatest);

  /// Lowers the limit to what can still win against a hit at `t`, or count below tmax = `t`.
  void set_limit(float t) {
    // Four operations on each side of the comparison, each off by at most 2^-24 of itself.
    limit = depth_limit(t) * (1.0f + 0x1p-20f);
  }
};

}  // namespace plumb::detail
