#pragma once

#include <cstdint>
#include <limits>

#include <glm/vec3.hpp>

namespace plumb {

/// The id that means "no triangle". Never the id of a triangle.
inline constexpr std::uint32_t kNone = 0xffffffffu;

/// A ray: the points `origin + t * direction` with max(tmin, 0) < t <= tmax.
///
/// A ray with a NaN in any of its eight floats, an infinite origin or direction, or a zero direction
/// sees nothing; none is an error.
struct Ray {
  glm::vec3 origin{0.0f, 0.0f, 0.0f};     ///< in the unit of the mesh's positions
  float tmin = 0.0f;                      ///< hits at or before it do not count; any value, -inf as well
  glm::vec3 direction{0.0f, 0.0f, 0.0f};  ///< of any length but zero: t is in multiples of that length
  float tmax = std::numeric_limits<float>::infinity();  ///< hits beyond it do not count; any value
};

/// What a ray sees. A miss is {+inf, kNone}.
struct Hit {
  /// Where: at origin + t * direction; the exact value rounded once to the nearest float. Greater than
  /// 0, and finite where something was hit.
  float t = std::numeric_limits<float>::infinity();
  /// What: the triangle's id in the whole scene.
  std::uint32_t id = kNone;

  /// Whether both are equal.
  friend bool operator==(const Hit&, const Hit&) = default;
};

// The library is compiled with GLM's packed types. A user's GLM settings (such as
// GLM_FORCE_DEFAULT_ALIGNED_GENTYPES) must not change the layout of what crosses its interface.
static_assert(sizeof(glm::vec3) == 12 && alignof(glm::vec3) == 4,
              "plumb needs GLM's packed vec3: do not force aligned types where it is included");
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 8);

}  // namespace plumb
