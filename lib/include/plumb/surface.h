#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb {

/// Where a ray meets a triangle with the vertices v0, v1, v2, for shading and the like.
///
/// Single precision, no further off than each member says, however far the ray's origin, however thin the
/// triangle and whatever the scale. The same bits on every machine.
struct Surface {
  /// Barycentric weight of v1, 0 to 1, off by less than one unit in its last place. The weight of v0 is
  /// the rest, 1 - u - v, so what the vertices hold is (1 - u - v) * a0 + u * a1 + v * a2 here.
  float u;
  /// Barycentric weight of v2, in the same way; u + v is at most 1 + 2^-23.
  float v;
  /// The point, from the triangle's vertices and not from the ray. Each coordinate is off by at most
  /// half a unit in its last place and 2^-30 of the triangle's longest edge, and lies between the
  /// least and the greatest of the vertices' coordinates.
  glm::vec3 point;
  /// (v1 - v0) x (v2 - v0) made a unit vector: seen from the side to which it points, v0, v1, v2 run
  /// counter-clockwise. It does not turn towards the ray. Each component is off by less than 2^-24.
  glm::vec3 normal;
};

/// Where `ray` meets the triangle that `hit`, an answer to this very ray, names: `hit.id` is its index in
/// the mesh, which must be the one that the ray was cast at. `hit.t` is not read, nor are the ray's
/// limits, as long as they are no NaN. Made on demand; the size of the mesh does not matter.
///
/// A triangle without area is never hit, so there is always a normal. Throws plumb::Error for a miss
/// (an id of kNone), an id that the mesh does not hold, a vertex index out of range, and a ray whose
/// line does not meet the triangle.
Surface surface(MeshView mesh, const Ray& ray, const Hit& hit);

/// The same for a mesh that is a part of a larger scene: `first_id` is the id of its first triangle.
Surface surface(MeshView mesh, const Ray& ray, const Hit& hit, std::uint32_t first_id);

}  // namespace plumb
