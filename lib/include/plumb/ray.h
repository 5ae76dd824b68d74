#pragma once

#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

namespace plumb {

/// The id that means "no triangle". Never the id of a triangle.
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// A ray: the points `origin + t * direction` with max(tmin, 0) < t <= tmax.
///
/// The direction may have any length but zero; t is measured in multiples of it. Either limit may be
/// infinite. A ray with a NaN in any of its eight floats, an infinite origin or direction, or a zero
/// direction sees nothing.
struct Ray {
  glm::vec3 origin{0.0f, 0.0f, 0.0f};
  float tmin = 0.0f;
  glm::vec3 direction{0.0f, 0.0f, 0.0f};
  float tmax = std::numeric_limits<float>::infinity();
};

/// What a ray sees: `t` is the exact distance rounded once to the nearest float, `id` the triangle's
/// id in the whole scene. A miss is {+inf, kNone}.
struct Hit {
  float t = std::numeric_limits<float>::infinity();
  std::uint32_t id = kNone;

  friend bool operator==(const Hit&, const Hit&) = default;
};

// The library is compiled with GLM's packed types. A user's GLM settings (such as
// GLM_FORCE_DEFAULT_ALIGNED_GENTYPES) must not change the layout of what crosses its interface.
static_assert(sizeof(glm::vec3) == 12 && alignof(glm::vec3) == 4,
              "plumb needs GLM's packed vec3: do not force aligned types where it is included");
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 8);

}  // namespace plumb
