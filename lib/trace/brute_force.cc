#include "plumb/brute_force.h"

#include <string>

#include "base/fp_mode.h"
#include "build/mesh_check.h"
#include "exact/intersect.h"
#include "plumb/error.h"
#include "trace/query.h"
#include "trace/span_calls.h"

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
    for (std::size_t i = 0; i < scene.triangle.size(); ++i) {
      float t = 0.0f;
      if (detail::line_hit(ray.origin, ray.direction, scene.triangle[i], t) && query.take(t, scene.id[i]))
        return;
    }
  }
};

}  // namespace

struct BruteForce::Impl {
  Triangles triangles;
  detail::QueryTable queries;
};

BruteForce::BruteForce(MeshView mesh, std::uint32_t first_id) {
  detail::check_mesh(mesh, first_id, "BruteForce");
  auto impl = std::make_shared<Impl>();
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const glm::uvec3& corners = mesh.triangles[i];
    const Triangle triangle{mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
    if (!detail::triangle_is_finite(triangle)) continue;
    impl->triangles.triangle.push_back(triangle);
    impl->triangles.id.push_back(first_id + static_cast<std::uint32_t>(i));
  }
  impl->queries = detail::make_query_table<Triangles, BruteTraversal>();
  impl_ = std::move(impl);
}

Hit BruteForce::closest(const Ray& ray) const {
  return detail::closest_of_one(impl_->queries, &impl_->triangles, ray);
}
bool BruteForce::any(const Ray& ray) const {
  return detail::any_of_one(impl_->queries, &impl_->triangles, ray);
}
void BruteForce::all(const Ray& ray, std::vector<Hit>& hits) const {
  detail::all_of_one(impl_->queries, &impl_->triangles, ray, hits);
}
void BruteForce::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
  detail::closest_of_span(impl_->queries, &impl_->triangles, rays, hits);
}
void BruteForce::any(std::span<const Ray> rays, std::span<bool> hits) const {
  detail::any_of_span(impl_->queries, &impl_->triangles, rays, hits);
}

}  // namespace plumb
