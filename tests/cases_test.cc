#include <doctest/doctest.h>

#include <gmpxx.h>

#include <array>
#include <cstddef>
#include <string>

#include "cases/cases.h"
#include "oracle/exact.h"
#include "oracle/oracle.h"
#include "support/oracle_adapter.h"

// That each hard case is what it says.

using namespace plumb;

namespace {

constexpr std::uint64_t kSeed = 1;

using Integer3 = std::array<mpz_class, 3>;

Integer3 integers(glm::vec3 v) { return {oracle::scaled(v.x), oracle::scaled(v.y), oracle::scaled(v.z)}; }

mpz_class determinant(const Integer3& d, const Integer3& a, const Integer3& b) {
  return d[0] * (a[1] * b[2] - a[2] * b[1]) + d[1] * (a[2] * b[0] - a[0] * b[2]) +
         d[2] * (a[0] * b[1] - a[1] * b[0]);
}

// How many of the triangle's three edge functions are exactly zero.
int zero_edges(const Ray& ray, const TriangleMesh& mesh, const glm::uvec3& triangle) {
  std::array<Integer3, 3> corners;
  const Integer3 origin = integers(ray.origin);
  for (int i = 0; i < 3; ++i) {
    corners[static_cast<std::size_t>(i)] = integers(mesh.positions[triangle[i]]);
    for (std::size_t k = 0; k < 3; ++k) corners[static_cast<std::size_t>(i)][k] -= origin[k];
  }
  const Integer3 direction = integers(ray.direction);
  int zeros = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    zeros += determinant(direction, corners[i], corners[(i + 1) % 3]) == 0 ? 1 : 0;
  }
  return zeros;
}

int zero_edges(const Ray& ray, const TriangleMesh& mesh) {
  int zeros = 0;
  for (const glm::uvec3& triangle : mesh.triangles) zeros += zero_edges(ray, mesh, triangle);
  return zeros;
}

}  // namespace

TEST_CASE("cases: every case has its own name and says how it is built and what is defined") {
  for (const cases::Case& c : cases::all_cases()) {
    CAPTURE(c.name);
    CHECK(cases::find_case(c.name) == &c);
    CHECK(c.built.ends_with('.'));
    CHECK(c.definition.ends_with('.'));
    CHECK(c.cost >= 1);
  }
  CHECK(cases::find_case("none of them") == nullptr);
}

TEST_CASE("cases: shared-edge aims every ray exactly at an edge") {
  const cases::Case& c = *cases::find_case("shared-edge");
  for (std::uint64_t i = 0; i < 100; ++i) {
    const cases::Instance instance = cases::make_instance(c, kSeed, i);
    for (const Ray& ray : instance.rays) CHECK(zero_edges(ray, instance.mesh) >= 1);
  }
}
