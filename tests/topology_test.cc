#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "plumb/builtin.h"
#include "plumb/error.h"
#include "plumb/topology.h"
#include "support/closed_meshes.h"
#include "support/random.h"

using namespace plumb;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInf = std::numeric_limits<float>::infinity();

// A tetrahedron of four positions; its last face may be left out.
TriangleMesh tetrahedron(bool whole = true) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}}};
  if (whole) mesh.triangles.emplace_back(1, 2, 3);
  return mesh;
}

// Both meshes, each with vertices of its own.
TriangleMesh both(TriangleMesh a, const TriangleMesh& b) {
  const auto first = static_cast<std::uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const glm::uvec3& t : b.triangles) a.triangles.push_back(t + first);
  return a;
}

TriangleMesh moved(TriangleMesh mesh, glm::vec3 by) {
  for (glm::vec3& p : mesh.positions) p += by;
  return mesh;
}

// As a file without shared vertices has it.
TriangleMesh torn(const TriangleMesh& mesh) {
  TriangleMesh result;
  for (const glm::uvec3& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(result.positions.size());
    for (int k = 0; k < 3; ++k) result.positions.push_back(mesh.positions[t[k]]);
    result.triangles.emplace_back(first, first + 1, first + 2);
  }
  return result;
}

// A band of `n` quads, closed to a ring, with half a turn or without.
TriangleMesh band(std::uint32_t n, bool half_turn) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < n; ++i) {
    const auto angle = static_cast<float>(i) / static_cast<float>(n) * 6.2831853f;
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), -0.1f);
    mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0.1f);
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = 2 * i, b = a + 1;
    const bool seam = half_turn && i + 1 == n;
    const std::uint32_t c = (2 * i + (seam ? 3 : 2)) % (2 * n), d = (2 * i + (seam ? 2 : 3)) % (2 * n);
    mesh.triangles.emplace_back(a, c, b);
    mesh.triangles.emplace_back(b, c, d);
  }
  return mesh;
}

// A grid of n x n quads whose opposite sides are one, the one pair the other way round.
TriangleMesh klein_bottle(std::uint32_t n) {
  TriangleMesh mesh;
  const auto vertex = [&](std::uint32_t x, std::uint32_t y) {
    const bool is_seam = x == n;
    return (is_seam ? 0 : x) * n + (is_seam ? n - y % n : y) % n;
  };
  for (std::uint32_t x = 0; x < n; ++x) {
    for (std::uint32_t y = 0; y < n; ++y) {
      mesh.positions.emplace_back(x, y, 0);  // where it lies is of no matter
      mesh.triangles.emplace_back(vertex(x, y), vertex(x + 1, y), vertex(x, y + 1));
      mesh.triangles.emplace_back(vertex(x, y + 1), vertex(x + 1, y), vertex(x + 1, y + 1));
    }
  }
  return mesh;
}

}  // namespace

TEST_SUITE("topology") {
  TEST_CASE("of closed surfaces: their components, no boundary, Euler's characteristic") {
    for (const hard::ClosedMesh& closed : hard::closed_meshes()) {
      CAPTURE(closed.name);
      for (const bool is_torn : {false, true}) {
        const Topology t = topology(is_torn ? torn(closed.mesh) : closed.mesh);
        const bool nested = closed.name == "cube within a cube";
        CHECK(t.closed());
        CHECK(t.manifold());
        CHECK(t.oriented());
        CHECK(t.triangles == closed.mesh.triangles.size());
        CHECK(t.positions == closed.mesh.positions.size());
        CHECK(t.edges == 3 * t.triangles / 2);
        CHECK(t.boundary_edges == 0);
        CHECK(t.boundary_loops == 0);
        CHECK(t.components == (nested ? 2 : 1));
        CHECK(t.euler_characteristic == (closed.name == "torus" ? 0 : nested ? 4 : 2));
        CHECK(t.repeated_vertices == (is_torn ? 3 * t.triangles - t.positions : 0));
        CHECK(t.degenerate + t.duplicates + t.non_finite + t.collapsed + t.unused_vertices == 0);
      }
    }
  }

  TEST_CASE("of nothing is nothing, and not closed") {
    const Topology t = topology(TriangleMesh{});
    CHECK(t.triangles == 0);
    CHECK_FALSE(t.closed());
    CHECK(t.components == 0);
    CHECK(topology(TriangleMesh{{{0, 0, 0}, {1, 1, 1}}, {}}).unused_vertices == 2);
  }

  TEST_CASE("a hole is a boundary of one loop") {
    const Topology t = topology(tetrahedron(false));
    CHECK_FALSE(t.closed());
    CHECK(t.manifold());
    CHECK(t.oriented());
    CHECK(t.boundary_edges == 3);
    CHECK(t.boundary_loops == 1);
    CHECK(t.euler_characteristic == 1);
    const Topology ring = topology(band(12, false));
    CHECK(ring.boundary_loops == 2);
    CHECK(ring.euler_characteristic == 0);
    CHECK(ring.oriented());
  }

  TEST_CASE("a Moebius band is manifold and not oriented, with one boundary") {
    const Topology t = topology(band(12, true));
    CHECK(t.turned_edges == 1);
    CHECK_FALSE(t.oriented());
    CHECK(t.manifold());
    CHECK(t.boundary_edges == 24);
    CHECK(t.boundary_loops == 1);
    CHECK(t.non_manifold_edges == 0);
    CHECK(t.components == 1);
    CHECK(t.euler_characteristic == 0);
    CHECK(t.unjoined_triangles == 2);
    CHECK(t.first_unjoined == std::vector<std::uint32_t>{0, 23});
  }

  TEST_CASE("a Klein bottle is closed and manifold, and cannot be oriented") {
    const Topology t = topology(klein_bottle(9));
    CHECK(t.closed());
    CHECK(t.manifold());
    CHECK_FALSE(t.oriented());
    CHECK(t.components == 1);
    CHECK(t.boundary_loops == 0);
    CHECK(t.euler_characteristic == 0);
  }

  TEST_CASE("a face turned over disagrees with its neighbours, and is closed all the same") {
    TriangleMesh mesh = tetrahedron();
    std::swap(mesh.triangles[0].x, mesh.triangles[0].y);
    const Topology t = topology(mesh);
    CHECK(t.turned_edges == 3);
    CHECK(t.closed());
    CHECK(t.manifold());
    CHECK_FALSE(t.oriented());
    CHECK(t.components == 1);
    CHECK(t.euler_characteristic == 2);
    CHECK(t.first_unjoined == std::vector<std::uint32_t>{0, 1, 2, 3});
  }

  TEST_CASE("two tetrahedra that share a vertex, an edge or a face") {
    // Each is the other mirrored in the origin, in an edge's middle, in a face.
    TriangleMesh mirrored = tetrahedron();
    for (glm::vec3& p : mirrored.positions) p = -p;
    for (glm::uvec3& t : mirrored.triangles) std::swap(t.x, t.y);
    const Topology vertex = topology(both(tetrahedron(), mirrored));
    CHECK(vertex.positions == 7);
    CHECK(vertex.closed());
    CHECK(vertex.non_manifold_edges == 0);
    CHECK(vertex.non_manifold_positions == 1);
    CHECK_FALSE(vertex.manifold());
    CHECK(vertex.components == 2);
    CHECK(vertex.euler_characteristic == 4);

    const Topology edge = topology(both(tetrahedron(), moved(mirrored, {1, 0, 0})));
    CHECK(edge.positions == 6);
    CHECK(edge.non_manifold_edges == 1);
    CHECK(edge.odd_edges == 0);
    CHECK(edge.closed());
    CHECK_FALSE(edge.manifold());
    CHECK_FALSE(edge.oriented());
    CHECK(edge.components == 1);
    CHECK(edge.unjoined_triangles == 4);

    const Topology same = topology(both(tetrahedron(), tetrahedron()));
    CHECK(same.duplicates == 4);
    CHECK(same.non_manifold_edges == 6);
    CHECK(same.closed());
  }

  TEST_CASE("three faces at an edge: a cross-section of a fin") {
    TriangleMesh mesh = tetrahedron();
    mesh.positions.emplace_back(0.5f, -1.0f, -1.0f);
    mesh.triangles.emplace_back(0, 1, 4);
    const Topology t = topology(mesh);
    CHECK(t.non_manifold_edges == 1);
    CHECK(t.odd_edges == 3);  // the fin's own two, and the one it stands on
    CHECK(t.boundary_edges == 2);
    CHECK_FALSE(t.closed());
    CHECK_FALSE(t.manifold());
    CHECK(t.components == 1);
    CHECK(t.euler_characteristic == 2);  // taken apart there: the fin, and a tetrahedron slit open
    CHECK(t.boundary_loops == 2);
    CHECK(t.first_unjoined == std::vector<std::uint32_t>{0, 1, 4});
  }

  TEST_CASE("non-finite, collapsed and degenerate triangles are told apart") {
    const TriangleMesh mesh{
        {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {kNan, 0, 0}, {0, kInf, 0}, {0, 1, 0}, {-0.0f, 0, 0}},
        {{0, 1, 3}, {0, 1, 4}, {0, 1, 2}, {0, 0, 1}, {0, 6, 1}, {0, 1, 5}, {5, 6, 1}, {1, 0, 5}}};
    const Topology t = topology(mesh);
    CHECK(t.non_finite == 2);
    CHECK(t.collapsed == 2);
    CHECK(t.degenerate == 3);
    CHECK(t.triangles == 4);
    CHECK(t.duplicates == 2);  // (5, 6, 1) and (1, 0, 5) of (0, 1, 5)
    CHECK(t.repeated_vertices == 1);
    CHECK(t.unused_vertices == 0);
  }

  TEST_CASE("no area is decided exactly") {
    // Collinear by construction, with differences that no float holds; and the same one float off.
    const glm::vec3 a{1.0f, 1.0f, 1.0f}, step{0x1p-20f + 0x1p-23f, 0x1p-21f + 0x1p-22f, -0x1p-19f};
    const TriangleMesh line{{a, a + step, a + step + step}, {{0, 1, 2}}};
    CHECK(topology(line).degenerate == 1);
    TriangleMesh off = line;
    off.positions[2].x = std::nextafter(off.positions[2].x, 2.0f);
    CHECK(topology(off).degenerate == 0);
    // Far apart in size: 2^100 and 2^-100.
    const TriangleMesh wide{{{0x1p100f, 0, 0}, {0, 0x1p-100f, 0}, {-0x1p100f, 0x1p-99f, 0}}, {{0, 1, 2}}};
    CHECK(topology(wide).degenerate == 1);
    TriangleMesh bent = wide;
    bent.positions[2].y = std::nextafter(0x1p-99f, 1.0f);
    CHECK(topology(bent).degenerate == 0);
  }

  TEST_CASE("the built-in scenes") {
    const Topology spheres = topology(builtin_scene("spheres:20000").mesh);
    CHECK(spheres.closed());
    CHECK(spheres.manifold());
    CHECK(spheres.euler_characteristic == static_cast<std::ptrdiff_t>(2 * spheres.components));
    const Topology terrain = topology(builtin_scene("terrain:5000").mesh);
    CHECK(terrain.boundary_edges == 200);
    CHECK(terrain.boundary_loops == 1);
    CHECK(terrain.euler_characteristic == 1);
    CHECK(topology(builtin_scene("soup:1000").mesh).components == 1000);
  }

  TEST_CASE("a hundred thousand triangles about one vertex, in any order, take no n^2 time") {
    constexpr std::uint32_t kCount = 100'000;
    TriangleMesh mesh;
    mesh.positions.emplace_back(0.0f, 0.0f, 1.0f);
    for (std::uint32_t i = 1; i <= kCount; ++i) {
      mesh.positions.emplace_back(i, i % 2, 0);
      mesh.triangles.emplace_back(0, i, i % kCount + 1);
    }
    hard::Random random(1);
    random.shuffle(mesh.triangles);
    const Topology t = topology(mesh);
    CHECK(t.manifold());
    CHECK(t.boundary_edges == kCount);
    CHECK(t.boundary_loops == 1);
    CHECK(t.euler_characteristic == 1);
  }

  TEST_CASE("progress rises and cancels, and an index out of range is an error") {
    const TriangleMesh mesh = builtin_scene("terrain:20000").mesh;
    double last = 0.0;
    topology(mesh, [&](double share) {
      CHECK(share >= last);
      CHECK(share <= 1.0);
      last = share;
      return true;
    });
    CHECK(last > 0.9);
    CHECK_THROWS_AS(topology(mesh, [](double share) { return share < 0.5; }), Cancelled);
    CHECK_THROWS_AS(topology(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}), Error);
  }
}
