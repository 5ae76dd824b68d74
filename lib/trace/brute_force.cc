#include "plumb/brute_force.h"

#include <memory>
#include <utility>
#include <vector>

#include "build/mesh_check.h"
#include "exact/intersect.h"
#include "trace/query.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

using detail::Triangle;

struct Triangles {
  std::vector<Triangle> triangle;
  std::vector<std::uint32_t> id;
};

struct BruteTraversal {
  template <typename Query>
  static void run(const Triangles& scene, const Ray& ray, Query& query) {
    query.count_triangles(scene.triangle.size());
    for (std::size_t i = 0; i < scene.triangle.size(); ++i) {
      float t = 0.0f;
      if (detail::line_hit(ray.origin, ray.direction, scene.triangle[i], t) && query.take(t, scene.id[i]))
        return;
    }
  }
};

Triangles copy_finite(MeshView mesh, std::uint32_t first_id) {
  Triangles result;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& corners = mesh.triangles[i];
    const Triangle triangle{mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
    if (!detail::triangle_is_finite(triangle)) continue;
    result.triangle.push_back(triangle);
    result.id.push_back(first_id + static_cast<std::uint32_t>(i));
  }
  return result;
}

detail::QueryTable brute_queries(Simd) { return detail::make_query_table<Triangles, BruteTraversal>(); }

std::shared_ptr<const detail::StructureData> build(MeshView mesh, std::uint32_t first_id) {
  detail::check_mesh(mesh, first_id, "BruteForce");
  const detail::BuildClock clock;
  Triangles triangles = copy_finite(mesh, first_id);
  Statistics statistics;
  statistics.triangles = mesh.triangles.size();
  statistics.references = triangles.id.size();
  statistics.unseen_triangles = statistics.triangles - statistics.references;
  statistics.leaves = 1;
  statistics.depth = 1;
  statistics.leaf_fill = 1.0;
  statistics.sah_cost = static_cast<double>(triangles.id.size());
  statistics.bytes = triangles.id.size() * (sizeof(Triangle) + sizeof(std::uint32_t));
  auto data = detail::make_structure_data(std::move(triangles), brute_queries, Simd::Auto);
  data->statistics = statistics;
  data->statistics.build_seconds = clock.seconds();
  return data;
}

}  // namespace

BruteForce::BruteForce(MeshView mesh, std::uint32_t first_id) : Structure(build(mesh, first_id)) {}

}  // namespace plumb
