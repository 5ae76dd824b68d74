#include "io/mesh_builder.h"

#include "io/finite.h"
#include "io/memory.h"
#include "io/text.h"

namespace plumb::detail {

std::string too_many_triangles(const MeshLimits& limits) {
  if (limits.first_id == 0) return too_many("triangles", limits.triangles);
  return "more than " + std::to_string(limits.triangles) + " triangles, whose ids begin at " +
         std::to_string(limits.first_id) + " and must stay below " + std::to_string(kNone) +
         "; split the scene";
}

void WholeMesh::reserve(std::uint64_t vertices, std::uint64_t triangles) {
  mesh_.positions.reserve(vertices);
  mesh_.triangles.reserve(triangles);
  expect_writes(mesh_.positions.data(), vertices * sizeof(glm::vec3));
  expect_writes(mesh_.triangles.data(), triangles * sizeof(glm::uvec3));
}

MeshReport WholeMesh::report() const {
  MeshReport report;
  report.vertices = mesh_.positions.size();
  report.triangles = mesh_.triangles.size();
  for (const glm::vec3& p : mesh_.positions) report.non_finite_vertices += is_finite(p) ? 0 : 1;
  if (report.non_finite_vertices == 0) return report;
  for (const glm::uvec3& t : mesh_.triangles) {
    const bool seen =
        is_finite(mesh_.positions[t.x]) && is_finite(mesh_.positions[t.y]) && is_finite(mesh_.positions[t.z]);
    report.unseen_triangles += seen ? 0 : 1;
  }
  return report;
}

}  // namespace plumb::detail
