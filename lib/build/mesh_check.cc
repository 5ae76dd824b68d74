#include "build/mesh_check.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "plumb/error.h"
#include "plumb/ray.h"

namespace plumb::detail {
namespace {

[[noreturn]] void fail_index(MeshView mesh, std::size_t triangle, const char* who) {
  const glm::uvec3& corners = mesh.triangles[triangle];
  const std::uint32_t index = std::max({corners.x, corners.y, corners.z});
  throw Error("plumb: " + std::string(who) + ": triangle " + std::to_string(triangle) +
              " has the vertex index " + std::to_string(index) + ", but the mesh has " +
              std::to_string(mesh.positions.size()) + " positions; every index must be below that");
}

}  // namespace

void check_mesh(MeshView mesh, std::uint32_t first_id, const char* who) {
  const std::size_t count = mesh.triangles.size();
  if (count > std::size_t{kNone} - first_id) {
    throw Error("plumb: " + std::string(who) + ": " + std::to_string(count) + " triangles from id " +
                std::to_string(first_id) + " on are too many; every id must be below " +
                std::to_string(kNone) + ", so split the mesh or lower first_id");
  }
  if (count == 0) return;

  // One maximum over all indices is fast; where the fault lies matters only when there is one.
  std::uint32_t greatest = 0;
  for (const glm::uvec3& corners : mesh.triangles) {
    greatest = std::max(greatest, std::max(corners.x, std::max(corners.y, corners.z)));
  }
  if (greatest < mesh.positions.size()) return;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::uvec3& corners = mesh.triangles[i];
    if (std::max({corners.x, corners.y, corners.z}) >= mesh.positions.size()) fail_index(mesh, i, who);
  }
}

}  // namespace plumb::detail
