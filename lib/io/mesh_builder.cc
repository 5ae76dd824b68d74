#include "io/mesh_builder.h"

#include <cmath>

#include "io/memory.h"

namespace plumb::detail {
namespace {

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

void MeshBuilder::reserve(std::uint64_t vertices, std::uint64_t triangles) {
  mesh_.positions.reserve(vertices);
  mesh_.triangles.reserve(triangles);
  expect_writes(mesh_.positions.data(), vertices * sizeof(glm::vec3));
  expect_writes(mesh_.triangles.data(), triangles * sizeof(glm::uvec3));
}

MeshReport MeshBuilder::report() const {
  MeshReport report;
  report.vertices = mesh_.positions.size();
  report.faces = faces_;
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
