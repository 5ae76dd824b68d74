#pragma once

#include <array>
#include <cstddef>

#include <gmpxx.h>

#include "exact/intersect.h"
#include "plumb/ray.h"

// The exact values that filters approximate, as integers: a value times 2^kScaleBits.

namespace plumb::attack {

/// Every float is a multiple of 2^-149 and every double of 2^-1074.
inline constexpr unsigned kScaleBits = 1100;

/// The edge functions, their sum and det(a, b, c) of docs/visibility.md.
struct ExactValues {
  mpz_class edge[3], den, t_num;

  ExactValues(const glm::vec3& origin, const glm::vec3& direction, const detail::Triangle& triangle);
};

/// |computed - exact| / bound; 0 where both differ by nothing, infinite for a bound of 0 that does not hold.
/// `computed` is finite.
double share_of_bound(double computed, const mpz_class& exact, double bound);

}  // namespace plumb::attack
