#include <doctest/doctest.h>

#include <cmath>

#include "cases_util.h"

// Edges, planes and origins: that each of these hard cases is what it says.

using namespace plumb;
using namespace plumb::cases;
using witness::Facts;

namespace {

bool through_edge(const Instance& instance, const Ray& ray) { return zero_edges(instance, ray) >= 1; }

int zero_components(const Ray& ray) {
  int zeros = 0;
  for (int i = 0; i < 3; ++i) zeros += ray.direction[i] == 0.0f ? 1 : 0;
  return zeros;
}

bool in_some_plane(const Instance& instance, const Ray& ray) {
  return any_fact(instance, ray, [](const Facts& facts) { return !facts.depth(); });
}

bool starts_on_edge(const Instance& instance, const Ray& ray) {
  return any_fact(instance, ray, [](const Facts& facts) { return facts.starts_on_edge(); });
}

bool starts_in_plane(const Instance& instance, const Ray& ray) {
  return any_fact(instance, ray, [](const Facts& facts) { return facts.starts_in_plane(); });
}

}  // namespace

TEST_CASE("cases: rays go exactly through edges and vertices") {
  CHECK(ray_share("shared-edge", through_edge) == 1.0);
  CHECK(ray_share("t-junction", through_edge) > 0.8);
  CHECK(ray_share("one-zero-component", through_edge) > 0.95);
  CHECK(pixel_share("edge-pixels", through_edge) > 0.7);
  CHECK(ray_share("non-manifold-fan", [](const Instance& instance, const Ray& ray) {
          return zero_edges(instance, ray) >= 3;
        }) == 1.0);
  // Two edges of each triangle meet at the vertex.
  CHECK(ray_share("fan-vertex", [](const Instance& instance, const Ray& ray) {
          return zero_edges(instance, ray) >= 2 * static_cast<int>(instance.mesh.triangles.size());
        }) == 1.0);
}

TEST_CASE("cases: a fan's vertex is hit exactly once") {
  CHECK(ray_share("fan-vertex", [](const Instance& instance, const Ray& ray) {
          return all_hits(instance, ray).size() == 1;
        }) == 1.0);
}

TEST_CASE("cases: rays run along edges and in planes") {
  CHECK(ray_share("along-edge", [](const Instance& instance, const Ray& ray) {
          return any_fact(instance, ray, [](const Facts& facts) { return facts.runs_along_edge(); });
        }) == 1.0);
  CHECK(ray_share("in-plane", in_some_plane) > 0.95);
  CHECK(pixel_share("in-plane", in_some_plane) > 0.05);
  CHECK(ray_share("box-face", in_some_plane) == 1.0);
  CHECK(ray_share("box-face", through_edge) > 0.95);
}

TEST_CASE("cases: components are zero, of both signs") {
  CHECK(ray_share("axis-parallel",
                  [](const Instance&, const Ray& ray) { return zero_components(ray) >= 1; }) == 1.0);
  CHECK(ray_share("axis-parallel",
                  [](const Instance&, const Ray& ray) { return zero_components(ray) == 2; }) > 0.6);
  CHECK(ray_share("one-zero-component",
                  [](const Instance&, const Ray& ray) { return zero_components(ray) == 1; }) > 0.95);
  for (const std::string_view name : {"axis-parallel", "one-zero-component"}) {
    const double negative = ray_share(name, [](const Instance&, const Ray& ray) {
      bool found = false;
      for (int i = 0; i < 3; ++i) {
        found = found || (ray.direction[i] == 0.0f && std::signbit(ray.direction[i]));
      }
      return found;
    });
    CHECK(negative > 0.3);
    CHECK(negative < 0.9);
  }
}

TEST_CASE("cases: grazing hits are steeper than a 500th of a right angle in none") {
  const auto flat = [](const Instance& instance, const Ray& ray) {
    const std::vector<oracle::Hit> hits = all_hits(instance, ray);
    if (hits.empty()) return true;
    const glm::uvec3 t = instance.mesh.triangles[hits.front().id];
    const glm::dvec3 v0 = instance.mesh.positions[t.x], d = ray.direction;
    const glm::dvec3 p = glm::dvec3(instance.mesh.positions[t.y]) - v0;
    const glm::dvec3 q = glm::dvec3(instance.mesh.positions[t.z]) - v0;
    const glm::dvec3 n(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x);
    const auto dot = [](const glm::dvec3& a, const glm::dvec3& b) {
      return a.x * b.x + a.y * b.y + a.z * b.z;
    };
    return std::fabs(dot(n, d)) < 0.003 * std::sqrt(dot(n, n) * dot(d, d));
  };
  CHECK(ray_share("grazing", flat) == 1.0);
  CHECK(ray_share("grazing", is_hit) > 0.5);
  CHECK(pixel_share("grazing", is_hit) > 0.2);
}

TEST_CASE("cases: rays and eyes start exactly on surfaces, edges and vertices") {
  CHECK(ray_share("origin-on-surface", starts_in_plane) == 1.0);
  CHECK(ray_share("origin-on-edge", starts_on_edge) > 0.98);  // the others have no direction
  CHECK(ray_share("origin-on-vertex", [](const Instance& instance, const Ray& ray) {
          const std::vector<glm::vec3>& p = instance.mesh.positions;
          return std::find(p.begin(), p.end(), ray.origin) != p.end();
        }) == 1.0);
  CHECK(pixel_share("eye-on-surface", starts_in_plane) > 0.6);
}

TEST_CASE("cases: rays start near surfaces but not on them") {
  CHECK(ray_share("origin-near-surface", starts_in_plane) < 0.5);
  // Scenes of about 1 to 8 in size; the origin is up to 2^-8 of that from a surface.
  CHECK(ray_share("origin-near-surface", [](const Instance& instance, const Ray& ray) {
          double least = 1e30;
          for (const glm::uvec3& t : instance.mesh.triangles) {
            const glm::dvec3 v0 = instance.mesh.positions[t.x];
            const glm::dvec3 p = glm::dvec3(instance.mesh.positions[t.y]) - v0;
            const glm::dvec3 q = glm::dvec3(instance.mesh.positions[t.z]) - v0;
            const glm::dvec3 n(p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x);
            const glm::dvec3 a = v0 - glm::dvec3(ray.origin);
            const double length = std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
            if (length > 0.0) least = std::min(least, std::fabs(a.x * n.x + a.y * n.y + a.z * n.z) / length);
          }
          return least < 0.125;
        }) == 1.0);
}
