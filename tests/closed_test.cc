#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/simd.h"
#include "support/closed_meshes.h"
#include "support/effort.h"
#include "support/random.h"

// Closed means closed: what docs/visibility.md promises of rays and closed surfaces, above all of those
// that go exactly through vertices and edges. Coordinates are small integers or halves of them, so that
// directions and the signs asked for here are exact in double.

using namespace plumb;
using hard::ClosedMesh;
using hard::Random;

namespace {

struct NamedTree {
  std::string name;
  Bvh bvh;
};

// Of each width the tree of every instruction set.
std::vector<NamedTree> trees_over(const TriangleMesh& mesh) {
  std::vector<NamedTree> trees;
  for (const int width : {2, 4, 8}) {
    for (const Simd simd : simd_targets()) {
      if (width == 2 && simd != simd_targets().front()) continue;
      BuildOptions options;
      options.width = width;
      options.simd = simd;
      trees.push_back(
          {"bvh" + std::to_string(width) + " " + std::string(simd_name(simd)), Bvh(mesh, options)});
    }
  }
  return trees;
}

struct Corners {
  glm::dvec3 v[3];
};

Corners corners_of(const TriangleMesh& mesh, std::uint32_t id) {
  const glm::uvec3& t = mesh.triangles[id];
  return {{mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]}};
}

glm::dvec3 cross(const glm::dvec3& p, const glm::dvec3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
double dot(const glm::dvec3& p, const glm::dvec3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// +1 where the direction leaves through the triangle's front, -1 where it enters, 0 in its plane.
int sense(const Corners& c, const glm::dvec3& direction) {
  const double along = dot(cross(c.v[1] - c.v[0], c.v[2] - c.v[0]), direction);
  return along > 0.0 ? 1 : along < 0.0 ? -1 : 0;
}

bool in_plane(const Corners& c, const glm::dvec3& p) {
  return dot(cross(c.v[1] - c.v[0], c.v[2] - c.v[0]), p - c.v[0]) == 0.0;
}

// Whether `hits` enter and leave by turns, where the ray starts at `depth` surfaces within: after all
// hits of one depth the ray is outside or inside once.
bool alternates(const TriangleMesh& mesh, const std::vector<Hit>& hits, const glm::dvec3& direction,
                int depth) {
  for (std::size_t i = 0; i < hits.size(); ++i) {
    depth -= sense(corners_of(mesh, hits[i].id), direction);
    const bool same_depth_goes_on = i + 1 < hits.size() && hits[i + 1].t == hits[i].t;
    if (!same_depth_goes_on && depth != 0 && depth != 1) return false;
  }
  return depth == 0;
}

// What rays are aimed at: vertices, and the middles of edges.
std::vector<glm::vec3> aims(const TriangleMesh& mesh) {
  std::vector<glm::vec3> places = mesh.positions;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      if (t[k] < t[(k + 1) % 3])
        places.push_back((mesh.positions[t[k]] + mesh.positions[t[(k + 1) % 3]]) * 0.5f);
    }
  }
  return places;
}

// A point of the lattice of halves that lies in no triangle's plane.
glm::vec3 open_point(const TriangleMesh& mesh, Random& random, int limit) {
  for (;;) {
    const glm::vec3 p = random.lattice3(2 * limit) * 0.5f;
    bool open = true;
    for (std::uint32_t id = 0; id < mesh.triangles.size() && open; ++id)
      open = !in_plane(corners_of(mesh, id), p);
    if (open) return p;
  }
}

glm::vec3 outside_point(Random& random) {
  glm::vec3 p = random.lattice3(16000) * 0.5f;
  p[static_cast<int>(random.below(3))] = static_cast<float>(random.one_in(2) ? 9001 : -9001) * 0.5f;
  return p;
}

}  // namespace

TEST_SUITE("closed surfaces") {
  TEST_CASE("the meshes are closed") {
    for (const ClosedMesh& closed : hard::closed_meshes()) {
      CAPTURE(closed.name);
      CHECK(hard::is_closed(closed.mesh));
    }
  }

  TEST_CASE("from outside a ray through vertices and edges enters and leaves by turns") {
    Random random(1);
    std::size_t crossings = 0;
    for (const ClosedMesh& closed : hard::closed_meshes()) {
      CAPTURE(closed.name);
      const std::vector<glm::vec3> places = aims(closed.mesh);
      const std::vector<NamedTree> trees = trees_over(closed.mesh);
      std::vector<Hit> hits;
      for (int i = 0; i < hard::effort(1000); ++i) {
        const glm::vec3 origin = outside_point(random);
        const glm::vec3 direction = random.pick(places) - origin;
        for (const NamedTree& tree : trees) {
          CAPTURE(tree.name);
          tree.bvh.all({origin, 0.0f, direction}, hits);
          CHECK(hits.size() % 2 == 0);
          CHECK(alternates(closed.mesh, hits, direction, 0));
          crossings += hits.size();
        }
      }
    }
    CHECK(crossings > 10'000u / hard::kEffortDivisor);
  }

  TEST_CASE("along the axes, through the planes and edges of a cube, too") {
    const ClosedMesh cube = hard::closed_meshes().front();
    const std::vector<NamedTree> trees = trees_over(cube.mesh);
    std::vector<Hit> hits;
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = -1088; i <= 1088; i += 64) {
        for (int j = -1088; j <= 1088; j += 64 * static_cast<int>(hard::kEffortDivisor)) {
          for (const float sign : {1.0f, -1.0f}) {
            Ray ray{glm::vec3(0.0f), 0.0f, glm::vec3(sign * 0.0f)};
            ray.origin[axis] = -4096.0f * sign;
            ray.origin[(axis + 1) % 3] = static_cast<float>(i);
            ray.origin[(axis + 2) % 3] = static_cast<float>(j);
            ray.direction[axis] = 1024.0f * sign;
            const bool inside = std::abs(i) < 1024 && std::abs(j) < 1024;
            const bool apart = std::abs(i) > 1024 || std::abs(j) > 1024;
            for (const NamedTree& tree : trees) {
              CAPTURE(tree.name);
              tree.bvh.all(ray, hits);
              CHECK(alternates(cube.mesh, hits, ray.direction, 0));
              if (inside) CHECK(hits.size() == 2);
              if (apart) CHECK(hits.empty());
            }
          }
        }
      }
    }
  }

  TEST_CASE("aimed at a vertex or an edge it hits one triangle of the sheet around it") {
    Random random(2);
    std::size_t sheets = 0;
    for (const ClosedMesh& closed : hard::closed_meshes()) {
      CAPTURE(closed.name);
      const TriangleMesh& mesh = closed.mesh;
      std::vector<std::vector<std::uint32_t>> around(mesh.positions.size());
      for (std::uint32_t id = 0; id < mesh.triangles.size(); ++id) {
        for (int k = 0; k < 3; ++k) around[mesh.triangles[id][k]].push_back(id);
      }
      const std::vector<NamedTree> trees = trees_over(mesh);
      std::vector<Hit> hits;
      for (int i = 0; i < hard::effort(600); ++i) {
        const glm::uvec3& t = mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
        const int k = static_cast<int>(random.below(3));
        const std::uint32_t a = t[k], b = random.one_in(2) ? a : t[(k + 1) % 3];
        std::vector<std::uint32_t> sheet;  // the triangles around the vertex a = b, or the edge from a to b
        for (const std::uint32_t id : around[a]) {
          if (std::find(around[b].begin(), around[b].end(), id) != around[b].end()) sheet.push_back(id);
        }
        const glm::vec3 origin = outside_point(random);
        const glm::vec3 direction = (mesh.positions[a] + mesh.positions[b]) * 0.5f - origin;
        // All on one side: the sheet lies around the ray. Else the ray grazes it, or it is folded there.
        int front = 0, back = 0;
        for (const std::uint32_t id : sheet) {
          const int s = sense(corners_of(mesh, id), direction);
          front += s > 0 ? 1 : 0;
          back += s < 0 ? 1 : 0;
        }
        const bool is_around = front + back == static_cast<int>(sheet.size()) && (front == 0 || back == 0);
        for (const NamedTree& tree : trees) {
          CAPTURE(tree.name);
          tree.bvh.all({origin, 0.0f, direction}, hits);
          const auto hit = std::count_if(hits.begin(), hits.end(), [&](const Hit& h) {
            return std::find(sheet.begin(), sheet.end(), h.id) != sheet.end();
          });
          // Whatever the sheet: those of its triangles that are hit are hit at the place aimed at.
          for (const Hit& h : hits) {
            if (std::find(sheet.begin(), sheet.end(), h.id) != sheet.end()) CHECK(h.t == 1.0f);
          }
          if (is_around) CHECK(hit == 1);
          if (front + back == static_cast<int>(sheet.size()) && a != b)
            CHECK(hit == (is_around ? 1 : hit / 2 * 2));
        }
        sheets += is_around ? 1u : 0u;
      }
    }
    CHECK(sheets > 2'000u / hard::kEffortDivisor);
  }

  TEST_CASE("inside or outside, by parity, is the same in every direction") {
    Random random(3);
    std::size_t inside_points = 0;
    for (const ClosedMesh& closed : hard::closed_meshes()) {
      CAPTURE(closed.name);
      const std::vector<glm::vec3> places = aims(closed.mesh);
      const std::vector<NamedTree> trees = trees_over(closed.mesh);
      std::vector<Hit> hits;
      for (int i = 0; i < hard::effort(16); ++i) {
        // Half of the points near the middle, where the spindle and the cones are thin.
        const glm::vec3 p = open_point(closed.mesh, random, i % 2 == 0 ? 4 : 1100);
        trees.front().bvh.all({p, 0.0f, {0.37f, 0.51f, -0.77f}}, hits);
        const std::size_t parity = hits.size() % 2;
        inside_points += parity;
        for (int j = 0; j < hard::effort(120); ++j) {
          const glm::vec3 direction = random.pick(places) - p;
          for (const NamedTree& tree : trees) {
            CAPTURE(tree.name);
            tree.bvh.all({p, 0.0f, direction}, hits);
            CHECK(hits.size() % 2 == parity);
            CHECK(alternates(closed.mesh, hits, direction, static_cast<int>(parity)));
          }
        }
      }
    }
    CHECK(inside_points > 30u / hard::kEffortDivisor);
  }

  TEST_CASE("a cloud of balls is left as often as entered, from anywhere outside and any direction") {
    const TriangleMesh mesh = builtin_scene("spheres:20000").mesh;
    REQUIRE(hard::is_closed(mesh));
    Random random(4);
    const std::vector<NamedTree> trees = trees_over(mesh);
    std::vector<Hit> hits;
    for (int i = 0; i < hard::effort(4000); ++i) {
      const glm::vec3 origin = outside_point(random) * (1.0f / 1024.0f);
      const glm::vec3 direction = random.pick(mesh.positions) - origin;
      for (const NamedTree& tree : trees) {
        CAPTURE(tree.name);
        tree.bvh.all({origin, 0.0f, direction}, hits);
        CHECK(hits.size() % 2 == 0);
      }
    }
  }
}
