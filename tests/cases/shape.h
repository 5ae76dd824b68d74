#pragma once

#include <cstdint>

#include "plumb/mesh.h"
#include "plumb/ray.h"
#include "support/random.h"

// What the cases are put together from. Coordinates are multiples of 2^-kFixedBits from -1 up to 1, so that
// the difference of two, and points at quarters of an edge, are floats exactly; products of them are not.

namespace plumb::cases {

using hard::Random;

inline constexpr int kFixedBits = 20;

/// A multiple of 2^-kFixedBits from -2^exponent up to 2^exponent.
float fixed(Random& random, int exponent = 0);
glm::vec3 fixed3(Random& random, int exponent = 0);

/// A new triangle with vertices of its own.
void add(TriangleMesh& mesh, glm::vec3 v0, glm::vec3 v1, glm::vec3 v2);

/// From `origin` towards `point`, whose difference is exact for fixed points; then of any length from
/// 2^-8 to 2^8 times that, which is exact as well.
Ray towards(Random& random, glm::vec3 origin, glm::vec3 point);

/// At quarters of the way from a to b, ends left out: exact for fixed points.
glm::vec3 between(Random& random, glm::vec3 a, glm::vec3 b);

}  // namespace plumb::cases
