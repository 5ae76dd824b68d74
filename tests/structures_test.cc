// What holds of every structure, each built as build_structure() does.

#include "plumb/structures.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "build_scenes.h"
#include "plumb/brute_force.h"
#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/octree.h"
#include "plumb/uniform_grid.h"
#include "support/effort.h"
#include "support/hard_rays.h"
#include "support/hard_scenes.h"

using namespace plumb;
using plumb::hard::Random;

namespace {

std::vector<Ray> rays_at(const TriangleMesh& mesh, std::uint64_t seed, int count) {
  Random random(seed);
  constexpr const char* kKinds[] = {"at_vertex",    "at_edge",       "at_inside",
                                    "from_surface", "axis_parallel", "in_plane"};
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) rays.push_back(hard::ray_of_kind(random, mesh, kKinds[i % 6]));
  return rays;
}

// How many of the rays are answered in another way, one by one, all hits, and in a span.
std::size_t differences(const Structure& structure, const Structure& expected, const std::vector<Ray>& rays) {
  std::size_t different = 0;
  std::vector<Hit> hits, expected_hits, of_span(rays.size());
  structure.closest(rays, of_span);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit hit = expected.closest(rays[i]);
    different += structure.closest(rays[i]) == hit ? 0 : 1;
    different += of_span[i] == hit ? 0 : 1;
    different += structure.any(rays[i]) == expected.any(rays[i]) ? 0 : 1;
    structure.all(rays[i], hits);
    expected.all(rays[i], expected_hits);
    different += hits == expected_hits ? 0 : 1;
  }
  return different;
}

template <typename Test>
void for_each_kind(const Test& test) {
  for (const StructureKind kind : structure_kinds()) {
    CAPTURE(std::string(structure_kind_name(kind)));
    StructureSettings settings;
    settings.kind = kind;
    test(settings);
  }
}

}  // namespace

TEST_SUITE("structures") {
  TEST_CASE("they answer as brute force does on every kind of scene and instruction set") {
    for (const build_scenes::Scene& scene : build_scenes::all(hard::effort(400u))) {
      CAPTURE(scene.name);
      const BruteForce brute(scene.mesh, 5);
      const std::vector<Ray> rays = rays_at(scene.mesh, 2, hard::effort(200));
      for_each_kind([&](StructureSettings& settings) {
        settings.first_id = 5;
        const Structure structure = build_structure(scene.mesh, settings);
        for (const Simd simd : simd_targets()) {
          CAPTURE(simd_name(simd));
          CHECK(differences(structure.with_simd(simd), brute, rays) == 0);
        }
      });
    }
  }

  TEST_CASE("and on hard scenes, where triangles lie in planes of cells and touch them") {
    for (const hard::SceneKind& kind : hard::scene_kinds()) {
      CAPTURE(kind.name);
      for (std::uint64_t seed = 0; seed < hard::effort(16u); ++seed) {
        Random random(seed);
        const TriangleMesh mesh = kind.make(random);
        const BruteForce brute(mesh);
        const std::vector<Ray> rays = rays_at(mesh, seed, 30);
        for_each_kind([&](StructureSettings& settings) {
          CHECK(differences(build_structure(mesh, settings), brute, rays) == 0);
        });
      }
    }
  }

  TEST_CASE("on the built-in scenes they answer as the binary tree does, and say what they are like") {
    for (const char* name :
         {"teapot-in-stadium:10000", "terrain:10000", "grid:20", "grass:10000", "soup:10000", "spheres:10000",
          "quads:100", "cornell", "cornell:5000", "ties:1000"}) {
      CAPTURE(name);
      const BuiltinScene scene = builtin_scene(name);
      BuildOptions options;
      options.width = 2;
      const Bvh boxes(scene.mesh, options);
      const std::vector<Ray> rays = rays_at(scene.mesh, 3, hard::effort(500));
      const Camera camera = scene.camera(67, 41);
      Frame expected(67, 41), frame(67, 41);
      cast(boxes, camera, expected);
      for_each_kind([&](StructureSettings& settings) {
        const Structure structure = build_structure(scene.mesh, settings);
        CHECK(differences(structure, boxes, rays) == 0);
        cast(structure, camera, frame);
        CHECK(compare(frame, expected).different_pixels == 0);
        const Statistics statistics = structure.statistics();
        CHECK(statistics.triangles == scene.mesh.triangles.size());
        CHECK(statistics.unseen_triangles == 0);
        CHECK(statistics.references >= scene.mesh.triangles.size());
        CHECK(statistics.leaves >= 1);
        CHECK(statistics.fill <= 1.0);
        CHECK(statistics.leaf_fill <= 1.0);
        CHECK(statistics.sah_cost > 0.0);
        CHECK(statistics.bytes >= 40 * scene.mesh.triangles.size());
        const TestCounts counts = structure.count_tests(rays);
        CHECK(counts.rays == rays.size());
        CHECK(counts.triangles > 0);
        CHECK((counts.volumes > 0 || settings.kind == StructureKind::BruteForce));
      });
    }
  }

  TEST_CASE("no triangle, one, and such as cannot be seen") {
    const Ray ray{{0, 0, 0}, 0.0f, {1, 0, 0}};
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const TriangleMesh mesh{{{1, -1, -1}, {1, 2, -1}, {1, -1, 2}, {nan, 0, 0}}, {{0, 1, 3}, {0, 1, 2}}};
    for_each_kind([&](StructureSettings& settings) {
      std::vector<Hit> hits{{1.0f, 1}};
      const Structure none = build_structure(TriangleMesh{}, settings);
      CHECK(none.closest(ray) == Hit{});
      CHECK_FALSE(none.any(ray));
      none.all(ray, hits);
      CHECK(hits.empty());
      CHECK(none.statistics().triangles == 0);
      const Structure one = build_structure(mesh, settings);
      CHECK(one.closest(ray) == Hit{1.0f, 1});
      CHECK(one.statistics().unseen_triangles == 1);
      CHECK(one.statistics().references == 1);
      CHECK(build_structure(TriangleMesh{{{nan, 0, 0}}, {{0, 0, 0}}}, settings).closest(ray) == Hit{});
      const TriangleMesh point{{{2, 0, 0}}, {{0, 0, 0}}};
      CHECK(build_structure(point, settings).closest(ray) == Hit{});
    });
  }

  TEST_CASE("many equal triangles, and many at one centre, keep memory in bounds") {
    const auto many = hard::effort(200'000u);
    for (const TriangleMesh& mesh : {build_scenes::repeated(many), build_scenes::concentric(many / 10)}) {
      const Ray ray{{0.5f, 0.75f, 5.0f}, 0.0f, {0, 0, -1}};
      const Hit expected = Bvh(mesh).closest(ray);
      for_each_kind([&](StructureSettings& settings) {
        const Structure structure = build_structure(mesh, settings);
        CHECK(structure.statistics().references <= 33 * mesh.triangles.size() + 1024);
        CHECK(structure.closest(ray) == expected);
      });
    }
  }

  TEST_CASE("errors and cancelling are as Bvh's") {
    const TriangleMesh mesh = build_scenes::soup(20'000, 1.0f, 0.1f, 1);
    for_each_kind([&](StructureSettings settings) {
      CHECK_THROWS_AS(build_structure(TriangleMesh{{{0, 0, 0}}, {{0, 0, 1}}}, settings), Error);
      StructureSettings bad = settings;
      bad.first_id = kNone - 19'999;
      CHECK_THROWS_AS(build_structure(mesh, bad), Error);
      if (settings.kind == StructureKind::BruteForce) return;
      bad = settings;
      bad.threads = -1;
      CHECK_THROWS_AS(build_structure(mesh, bad), Error);
      double last = 0.0;
      bool rises = true;
      settings.progress = [&](double share) {
        rises = rises && share >= last && share <= 1.0;
        last = share;
        return true;
      };
      build_structure(mesh, settings);
      CHECK(rises);
      CHECK(last > 0.8);
      settings.progress = [](double share) { return share < 0.3; };
      CHECK_THROWS_AS(build_structure(mesh, settings), Cancelled);
      settings.progress = [](double) -> bool { throw 17; };
      CHECK_THROWS_AS(build_structure(mesh, settings), int);
    });
    StructureSettings none;
    none.kind = static_cast<StructureKind>(99);
    CHECK_THROWS_AS(build_structure(mesh, none), Error);
    CHECK_THROWS_AS(UniformGrid(mesh, {.cells_per_triangle = 0.0}), Error);
    CHECK_THROWS_AS(UniformGrid(mesh, {.cells_per_triangle = std::numeric_limits<double>::quiet_NaN()}),
                    Error);
  }

  TEST_CASE("a grid of any number of cells answers alike") {
    const TriangleMesh mesh = builtin_scene("teapot-in-stadium:3000").mesh;
    const BruteForce brute(mesh);
    const std::vector<Ray> rays = rays_at(mesh, 7, hard::effort(300));
    std::size_t last = 0;
    for (const double cells : {0.001, 0.1, 1.0, 10.0, 1000.0}) {
      CAPTURE(cells);
      const UniformGrid grid(mesh, {.cells_per_triangle = cells});
      CHECK(differences(grid, brute, rays) == 0);
      CHECK(grid.statistics().bytes >= last);
      last = grid.statistics().bytes;
    }
  }
}
