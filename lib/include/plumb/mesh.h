#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb {

/// Triangles as indices into positions. A triangle's id is its index here (plus `first_id` where a
/// mesh is a part of a larger scene). Nothing is welded, moved or dropped: degenerate and non-finite
/// triangles keep their ids.
struct TriangleMesh {
  std::vector<glm::vec3> positions;
  std::vector<glm::uvec3> triangles;
};

/// A non-owning view of a mesh: what every function of the library takes. The memory it points to
/// must outlive the call (not longer: everything that is kept is copied).
struct MeshView {
  std::span<const glm::vec3> positions;
  std::span<const glm::uvec3> triangles;

  MeshView() = default;
  MeshView(std::span<const glm::vec3> positions_in, std::span<const glm::uvec3> triangles_in)
      : positions(positions_in), triangles(triangles_in) {}
  MeshView(const TriangleMesh& mesh) : positions(mesh.positions), triangles(mesh.triangles) {}
};

static_assert(sizeof(glm::uvec3) == 12, "plumb needs GLM's packed uvec3");

}  // namespace plumb
