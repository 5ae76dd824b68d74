#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <glm/common.hpp>

#include "plumb/error.h"
#include "scene/teapot.h"

using namespace plumb;

namespace {

// Edges between vertices that are equal in value, as directed pairs with how often they occur.
using Edge = std::pair<int, int>;
std::map<Edge, int> welded_edges(const TriangleMesh& mesh) {
  std::map<std::tuple<float, float, float>, int> vertices;
  const auto vertex = [&](std::uint32_t index) {
    const glm::vec3& p = mesh.positions[index];
    return vertices.try_emplace({p.x, p.y, p.z}, static_cast<int>(vertices.size())).first->second;
  };
  std::map<Edge, int> edges;
  for (const glm::uvec3& t : mesh.triangles) {
    const int a = vertex(t.x), b = vertex(t.y), c = vertex(t.z);
    ++edges[{a, b}];
    ++edges[{b, c}];
    ++edges[{c, a}];
  }
  return edges;
}

TriangleMesh teapot(int segments) {
  TriangleMesh mesh;
  detail::append_teapot(mesh, segments, {0.0, 0.0, 0.0}, 1.0);
  return mesh;
}

}  // namespace

TEST_SUITE("teapot") {
  TEST_CASE("the control points are the published ones") {
    // The literal is the hash of the 32 published patches, their indices looked up in the list of 306
    // points, computed apart from this code.
    const std::vector<detail::TeapotPatch> patches = detail::teapot_patches();
    REQUIRE(patches.size() == 32);
    std::uint64_t hash = 14695981039346656037u;
    std::set<std::tuple<std::int64_t, std::int64_t, std::int64_t>> points;
    for (const detail::TeapotPatch& patch : patches) {
      for (const detail::TeapotPoint& p : patch) {
        points.insert({p.x, p.y, p.z});
        for (const std::int64_t c : {p.x, p.y, p.z})
          hash = (hash ^ static_cast<std::uint64_t>(c)) * 1099511628211u;
      }
    }
    CHECK(hash == 0xe676a227b667a899u);
    // Of the 306 four belong to no patch, and the 12 of the foot's edge are listed twice.
    CHECK(points.size() == 306 - 4 - 12);
  }

  TEST_CASE("patches meet without cracks: the only open edges are the published surface's own") {
    // The body is open at the rim (4 patches around) and the lid at its lower edge (4); handle and spout are
    // tubes (2 patches around) with two open ends each. With n = 1 the tubes would be flat.
    for (const int n : {2, 3, 7, 16}) {
      CAPTURE(n);
      const std::map<Edge, int> edges = welded_edges(teapot(n));
      int open = 0, repeated = 0;
      for (const auto& [edge, count] : edges) {
        repeated += count > 1 ? 1 : 0;
        open += edges.contains({edge.second, edge.first}) ? 0 : 1;
      }
      CHECK(repeated == 0);  // the triangles of neighbours run the same way around
      CHECK(open == (4 + 4 + 2 * 2 + 2 * 2) * n);
    }
  }

  TEST_CASE("no triangle is collapsed, and the poles' quads are triangles") {
    for (const int n : {1, 2, 9, 24}) {
      const TriangleMesh mesh = teapot(n);
      CHECK(mesh.triangles.size() == static_cast<std::size_t>(64 * n * n - 8 * n));
      for (const glm::uvec3& t : mesh.triangles) {
        const glm::vec3 &a = mesh.positions[t.x], &b = mesh.positions[t.y], &c = mesh.positions[t.z];
        REQUIRE(a != b);
        REQUIRE(b != c);
        REQUIRE(c != a);
      }
    }
  }

  TEST_CASE("the teapot stands on its foot and has its known extent") {
    TriangleMesh mesh;
    detail::append_teapot(mesh, 32, {10.0, 20.0, 30.0}, 2.0);
    glm::vec3 lo = mesh.positions[0], hi = lo;
    for (const glm::vec3& p : mesh.positions) lo = glm::min(lo, p), hi = glm::max(hi, p);
    CHECK(lo.y == 20.0f);  // the bottom is flat
    CHECK(hi.y == 26.3f);  // the knob's top, 3.15 high
    CHECK(lo.x == 6.0f);   // the body's greatest radius is 2
    CHECK(hi.x == 14.0f);
    CHECK(lo.z == 24.0f);  // the handle reaches back to 3
    CHECK(hi.z > 36.8f);   // and the spout forward to 3.434
    CHECK(hi.z < 36.9f);
  }

  TEST_CASE("the finest teapot does not overflow") {
    const TriangleMesh mesh = teapot(detail::kMaxTeapotSegments);
    float greatest = 0.0f;
    for (const glm::vec3& p : mesh.positions) {
      greatest = std::max({greatest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    }
    CHECK(greatest < 3.5f);
    CHECK_THROWS_AS(teapot(detail::kMaxTeapotSegments + 1), Error);
    CHECK_THROWS_AS(teapot(0), Error);
  }
}
