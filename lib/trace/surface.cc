#include "plumb/surface.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/fp_mode.h"
#include "base/round.h"
#include "exact/determinant.h"
#include "exact/double_stage.h"
#include "exact/intersect.h"
#include "plumb/error.h"

// The weights are the edge functions over their sum: E1 belongs to v0, E2 to v1, E0 to v2. Where double
// leaves one of them, or the normal, with a relative error above kEnough (a ray close to an edge, far from
// the triangle or along it; a thin triangle), expansions give it again, to the last bits of a double.

namespace plumb {
namespace {

using detail::Double3;
using detail::Triangle;

// Against half a unit in the last place of a float, 2^-25 of it or more, this hardly counts.
constexpr double kEnough = 0x1p-32;

struct Edges {
  double of_v0, of_v1, of_v2;
};

double exact_edge(const Ray& ray, const glm::vec3& p, const glm::vec3& q) {
  detail::Expansion<36> edge;
  detail::add_dot(edge, detail::cross_about(p, q, ray.origin), ray.direction, 1.0);
  return edge.estimate();
}

Edges edges_of(const Ray& ray, const Triangle& triangle, const detail::DoubleStage& stage) {
  const double least = std::min({std::fabs(stage.edge0), std::fabs(stage.edge1), std::fabs(stage.edge2)});
  if (stage.e_error < kEnough * least) return {stage.edge1, stage.edge2, stage.edge0};
  return {exact_edge(ray, triangle.v1, triangle.v2), exact_edge(ray, triangle.v2, triangle.v0),
          exact_edge(ray, triangle.v0, triangle.v1)};
}

Double3 normal_of(const Triangle& triangle, const detail::DoubleStage& stage) {
  if (stage.n_error < kEnough * detail::norm_max(stage.n)) return stage.n;
  const detail::ExactNormal n = detail::cross_about(triangle.v1, triangle.v2, triangle.v0);
  return {n.x.estimate(), n.y.estimate(), n.z.estimate()};
}

// A float's square, and a determinant's, is far from the ends of double's range.
glm::vec3 unit_vector(const Double3& n) {
  const double length = std::sqrt(detail::dot(n, n));
  return {detail::round_to_float(n.x / length), detail::round_to_float(n.y / length),
          detail::round_to_float(n.z / length)};
}

// v0 + w1 (v1 - v0) + w2 (v2 - v0): off by the weights' error times an edge, and by a few roundings of a
// coordinate no greater than the point's own and an edge.
float coordinate(double v0, double v1, double v2, double w1, double w2) {
  const double value = v0 + (w1 * (v1 - v0) + w2 * (v2 - v0));
  return detail::round_to_float(std::clamp(value, std::min({v0, v1, v2}), std::max({v0, v1, v2})));
}

[[noreturn]] void fail(std::uint32_t id, const std::string& what) {
  throw Error("plumb: surface: triangle " + std::to_string(id) + " " + what);
}

Triangle triangle_of(MeshView mesh, std::uint32_t id, std::uint32_t first_id) {
  if (id == kNone) throw Error("plumb: surface: the hit is a miss; ask only where something was hit");
  if (id < first_id || id - first_id >= mesh.triangles.size()) {
    fail(id, "is not in the mesh, which holds " + std::to_string(mesh.triangles.size()) + " from id " +
                 std::to_string(first_id) + " on; pass the mesh that was hit, with its first_id");
  }
  const glm::uvec3& corners = mesh.triangles[id - first_id];
  const std::uint32_t greatest = std::max({corners.x, corners.y, corners.z});
  if (greatest >= mesh.positions.size()) {
    fail(id, "has the vertex index " + std::to_string(greatest) + ", but the mesh has " +
                 std::to_string(mesh.positions.size()) + " positions; every index must be below that");
  }
  return {mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
}

[[gnu::noinline]] Surface make_surface(MeshView mesh, const Ray& ray, const Hit& hit,
                                       std::uint32_t first_id) {
  const Triangle triangle = triangle_of(mesh, hit.id, first_id);
  const char* const not_met = "is not met by the ray; pass the ray that the hit answers";
  if (!detail::ray_is_valid(ray) || !detail::triangle_is_finite(triangle)) fail(hit.id, not_met);

  const detail::DoubleStage stage(ray.origin, ray.direction, triangle);
  const Edges edges = edges_of(ray, triangle, stage);
  // The signs are exact; what the displacement decides is 0 here.
  const double sum = (edges.of_v0 + edges.of_v1) + edges.of_v2;
  const bool met = std::min({edges.of_v0, edges.of_v1, edges.of_v2}) >= 0.0 ||
                   std::max({edges.of_v0, edges.of_v1, edges.of_v2}) <= 0.0;
  if (!met || sum == 0.0) fail(hit.id, not_met);

  // Adding 0 turns the weight -0 into 0.
  const double w1 = edges.of_v1 / sum + 0.0;
  const double w2 = edges.of_v2 / sum + 0.0;
  const auto& [v0, v1, v2] = triangle;
  return {detail::round_to_float(w1),
          detail::round_to_float(w2),
          {coordinate(v0.x, v1.x, v2.x, w1, w2), coordinate(v0.y, v1.y, v2.y, w1, w2),
           coordinate(v0.z, v1.z, v2.z, w1, w2)},
          unit_vector(normal_of(triangle, stage))};
}

}  // namespace

Surface surface(MeshView mesh, const Ray& ray, const Hit& hit, std::uint32_t first_id) {
  return detail::with_default_fp_mode([&] { return make_surface(mesh, ray, hit, first_id); });
}

Surface surface(MeshView mesh, const Ray& ray, const Hit& hit) { return surface(mesh, ray, hit, 0); }

}  // namespace plumb
