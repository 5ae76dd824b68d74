#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb {

/// Triangles as indices into positions. A triangle's id is its index here (plus `first_id` where a
/// mesh is a part of a larger scene). Nothing is welded, moved or dropped: degenerate and non-finite
/// triangles keep their ids, and are never seen.
struct TriangleMesh {
  std::vector<glm::vec3> positions;   ///< vertices; any floats, in any unit
  std::vector<glm::uvec3> triangles;  ///< three indices into positions each, in either winding
};

/// A non-owning view of a mesh: what every function of the library takes. The memory it points to
/// must outlive the call (not longer: everything that is kept is copied). An index that is not below
/// the number of positions is plumb::Error from whatever reads it.
struct MeshView {
  std::span<const glm::vec3> positions;   ///< as TriangleMesh::positions
  std::span<const glm::uvec3> triangles;  ///< as TriangleMesh::triangles

  /// A mesh without triangles.
  MeshView() = default;
  /// A view of any arrays of positions and triangles.
  MeshView(std::span<const glm::vec3> positions_in, std::span<const glm::uvec3> triangles_in)
      : positions(positions_in), triangles(triangles_in) {}
  /// A view of the mesh; not explicit, so that a TriangleMesh goes wherever a view does.
  MeshView(const TriangleMesh& mesh) : positions(mesh.positions), triangles(mesh.triangles) {}
};

static_assert(sizeof(glm::uvec3) == 12, "plumb needs GLM's packed uvec3");

}  // namespace plumb
