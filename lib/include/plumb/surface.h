#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb {

/// Where a ray meets a triangle with the vertices v0, v1, v2, for shading and the like.
///
/// Everything here is the exact answer rounded to single precision, and however far the ray's origin,
/// however thin the triangle and whatever the scale, no further off than each member says.
struct Surface {
  /// Barycentric weights of v1 and v2, 0 to 1; v0 has the rest, 1 - u - v. Something that each vertex
  /// has, interpolated: (1 - u - v) * a0 + u * a1 + v * a2. Off by less than one unit in the last
  /// place, so u + v is at most 1 + 2^-23.
  float u, v;
  /// The point, from the triangle's vertices and not from the ray. Each coordinate is off by at most
  /// half a unit in its last place and 2^-30 of the triangle's longest edge, and lies between the
  /// least and the greatest of the vertices' coordinates.
  glm::vec3 point;
  /// (v1 - v0) x (v2 - v0) made a unit vector: seen from the side to which it points, v0, v1, v2 run
  /// counter-clockwise. It does not turn towards the ray. Each component is off by less than 2^-24.
  glm::vec3 normal;
};

/// Where `ray` meets the triangle of `hit`, which an answer to this very ray named: `hit.id` is the
/// triangle's index in the mesh. `hit.t` is not read. Takes the same time for a mesh of any size.
///
/// A triangle without area is never hit, so there is always a normal. Throws plumb::Error for a miss
/// (an id of kNone), an id that the mesh does not hold, a vertex index out of range, and a ray whose
/// line does not meet the triangle.
Surface surface(MeshView mesh, const Ray& ray, const Hit& hit);

/// The same for a mesh that is a part of a scene: `first_id` is the id of its first triangle.
Surface surface(MeshView mesh, const Ray& ray, const Hit& hit, std::uint32_t first_id);

}  // namespace plumb
