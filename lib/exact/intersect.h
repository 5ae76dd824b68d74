#pragma once

#include <glm/vec3.hpp>

#include "plumb/ray.h"

// The answer of docs/visibility.md for one ray and one triangle, in plain scalar code: double with a
// proven bound, then expansions. Every way to cast or rasterize ends here for what its own filter
// leaves open. Callers hold the default floating-point mode (base/fp_mode.h).

namespace plumb::detail {

struct Triangle {
  glm::vec3 v0, v1, v2;
};

/// Whether the ray can see anything: no NaN, finite origin and direction, a direction that is not
/// zero.
inline bool ray_is_valid(const Ray& ray) {
  const glm::vec3& o = ray.origin;
  const glm::vec3& d = ray.direction;
  // A product with 0 is NaN for what is not finite, and what is NaN is not equal to itself.
  const float zero = ((o.x * 0.0f + o.y * 0.0f) + (o.z * 0.0f + d.x * 0.0f)) + (d.y * 0.0f + d.z * 0.0f);
  return zero == 0.0f && (d.x != 0.0f || d.y != 0.0f || d.z != 0.0f) && ray.tmin == ray.tmin &&
         ray.tmax == ray.tmax;
}

/// Whether all nine coordinates are finite.
bool triangle_is_finite(const Triangle& triangle);

/// The displaced ray's line meets the triangle, the denominator is not zero and RN32(t) is finite:
/// then true, and `t` is RN32(t), of either sign. tmin and tmax are not looked at. The ray must be
/// valid and the triangle finite.
bool line_hit(const glm::vec3& origin, const glm::vec3& direction, const Triangle& triangle, float& t);

/// RN32(t) where the caller has proved that the line meets the triangle with a denominator that is not
/// zero. Infinite where it rounds so.
float line_depth(const glm::vec3& origin, const glm::vec3& direction, const Triangle& triangle);

/// line_hit() for a ray; `covered` says that the caller has proved that the line meets the triangle with a
/// denominator that is not zero. False as well for a hit that does not count on the ray for certain, or whose
/// exact t is above `limit` for certain, before much is spent on its t.
bool ray_hit(const Ray& ray, const Triangle& triangle, bool covered, float limit, float& t);

/// Whether ray_hit() and t counts on the ray, for who does not ask for t.
bool ray_meets(const Ray& ray, const Triangle& triangle, bool covered);

/// Whether a hit at this (rounded) t counts on the ray.
inline bool depth_counts(const Ray& ray, float t) {
  return t > (ray.tmin > 0.0f ? ray.tmin : 0.0f) && t <= ray.tmax;
}

/// Whether (t, id) comes before the best so far.
inline bool hit_before(float t, std::uint32_t id, const Hit& best) {
  return t < best.t || (t == best.t && id < best.id);
}

}  // namespace plumb::detail
