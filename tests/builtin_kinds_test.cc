#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/camera.h"

// What each built-in scene is made for, seen by casting rays into it.

using namespace plumb;

namespace {

// Calls look(hits) for the hits of every `step`-th pixel's ray.
template <typename Look>
void look_through(const BuiltinScene& scene, int width, int height, int step, Look look) {
  const Bvh bvh(scene.mesh);
  const Camera camera = scene.camera(width, height);
  std::vector<Hit> hits;
  for (int y = 0; y < height; y += step) {
    for (int x = 0; x < width; x += step) {
      bvh.all(camera.ray(x, y), hits);
      look(hits);
    }
  }
}

}  // namespace

TEST_SUITE("grass, soup and spheres") {
  TEST_CASE("a ray into the grass meets several blades, all but one of them hidden") {
    std::size_t rays = 0, met = 0;
    look_through(builtin_scene("grass:100000"), 160, 90, 3, [&](const std::vector<Hit>& hits) {
      rays += hits.empty() ? 0u : 1u;
      met += hits.size();
    });
    CHECK(rays > 600);
    CHECK(met > 2 * rays);
  }

  TEST_CASE("a box of a tree over the soup is met as often at every size") {
    // The number of triangles met grows as the third root of their number.
    double per_ray[2] = {};
    for (const int i : {0, 1}) {
      std::size_t rays = 0, met = 0;
      look_through(builtin_scene(i == 0 ? "soup:2000" : "soup:128000"), 160, 90, 3,
                   [&](const std::vector<Hit>& hits) {
                     rays += hits.empty() ? 0u : 1u;
                     met += hits.size();
                   });
      per_ray[i] = static_cast<double>(met) / static_cast<double>(rays);
    }
    CHECK(per_ray[1] / per_ray[0] > 2.5);
    CHECK(per_ray[1] / per_ray[0] < 6.0);
  }

  TEST_CASE("every sphere is closed: each edge belongs to two triangles, once in each direction") {
    for (const char* name : {"spheres:8", "spheres:32", "spheres:100", "spheres:20000"}) {
      CAPTURE(name);
      std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
      const TriangleMesh mesh = builtin_scene(name).mesh;
      for (const glm::uvec3& t : mesh.triangles) {
        for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
      }
      const bool paired = std::all_of(edges.begin(), edges.end(), [&](const auto& edge) {
        const auto other = edges.find({edge.first.second, edge.first.first});
        return edge.second == 1 && other != edges.end();
      });
      CHECK(paired);
    }
  }

  TEST_CASE("spheres are seen from outside: a ray leaves as often as it enters") {
    std::size_t odd = 0, rays = 0;
    look_through(builtin_scene("spheres:20000"), 320, 180, 1, [&](const std::vector<Hit>& hits) {
      odd += hits.size() % 2;
      rays += hits.empty() ? 0u : 1u;
    });
    CHECK(rays > 5'000);
    CHECK(odd == 0);
  }
}

TEST_SUITE("quads and cornell") {
  TEST_CASE("each layer fills the view, and the last is in front") {
    for (const int width : {160, 360}) {  // four to one
      std::size_t wrong = 0;
      look_through(builtin_scene("quads:50"), width, 90, 1, [&](const std::vector<Hit>& hits) {
        if (hits.size() != 50) ++wrong;
        for (std::size_t i = 0; i < hits.size(); ++i) wrong += hits[i].id / 2 == 49 - i ? 0u : 1u;
      });
      CHECK(wrong == 0);
    }
  }

  TEST_CASE("the lamp of the Cornell box is as deep as the ceiling, and is what is seen") {
    const BuiltinScene scene = builtin_scene("cornell");
    CHECK(scene.mesh.triangles.size() == 32);
    const Bvh bvh(scene.mesh);
    std::vector<Hit> hits;
    bvh.all({{278.0f, 10.0f, 280.0f}, 0.0f, {0.0f, 1.0f, 0.0f}, 1000.0f}, hits);
    REQUIRE(hits.size() == 2);
    CHECK(hits[0].t == hits[1].t);
    CHECK(hits[0].id < 2);
  }
}

TEST_SUITE("ties") {
  TEST_CASE("in a good part of the frame depths tie, and not by the order of the triangles") {
    std::size_t pixels = 0, tied = 0, deep = 0, first_seen = 0;
    look_through(builtin_scene("ties:6400"), 320, 180, 1, [&](const std::vector<Hit>& hits) {
      if (hits.size() < 2) return;
      ++pixels;
      tied += hits[0].t == hits[1].t ? 1u : 0u;
      deep += hits[1].t > hits[0].t && hits[1].t < hits[0].t + 0.001f ? 1u : 0u;
      const auto least =
          std::min_element(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.id < b.id; });
      first_seen += least == hits.begin() ? 1u : 0u;
    });
    CHECK(pixels > 50'000);
    CHECK(tied > pixels / 20);
    CHECK(deep > pixels / 2);
    CHECK(first_seen < pixels / 4);
  }
}
