#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "plumb/brute_force.h"
#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/layers.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "support/effort.h"
#include "support/hard_views.h"
#include "support/oracle_adapter.h"
#include "support/random.h"
#include "support/structures_of_cells.h"

// The first hits of every pixel, by rays and by triangles, against the oracle and against lists of all hits.

using namespace plumb;

namespace {

constexpr int kThreads[] = {1, 2, 5};

void set(LayeredFrame& frame, int x, int y, const std::vector<Hit>& hits) {
  const auto layers = static_cast<std::size_t>(frame.layers);
  const std::size_t first =
      (static_cast<std::size_t>(y) * static_cast<std::size_t>(frame.width) + static_cast<std::size_t>(x)) *
      layers;
  for (std::size_t l = 0; l < std::min(hits.size(), layers); ++l) {
    frame.depth[first + l] = hits[l].t;
    frame.id[first + l] = hits[l].id;
  }
}

// From the lists of all hits along the pixels' rays.
template <typename All>
LayeredFrame expected_layers(const Camera& camera, int layers, const All& all) {
  LayeredFrame frame(camera.width, camera.height, layers);
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) set(frame, x, y, all(camera.ray(x, y)));
  }
  return frame;
}

LayeredFrame oracle_layers(const TriangleMesh& mesh, const Camera& camera, int layers) {
  const oracle::Scene scene(witness::to_oracle(mesh));
  return expected_layers(
      camera, layers, [&](const Ray& ray) { return witness::to_plumb(scene.all(witness::to_oracle(ray))); });
}

LayeredFrame brute_layers(const TriangleMesh& mesh, const Camera& camera, int layers) {
  const BruteForce brute(mesh);
  return expected_layers(camera, layers, [&](const Ray& ray) {
    std::vector<Hit> hits;
    brute.all(ray, hits);
    return hits;
  });
}

std::string difference(const LayeredFrame& frame, const LayeredFrame& expected) {
  for (int l = 0; l < expected.layers; ++l) {
    const std::string text = hard::difference(frame.layer(l), expected.layer(l));
    if (!text.empty()) return "layer " + std::to_string(l) + ": " + text;
  }
  return "";
}

LayeredFrame cast_of(const Structure& structure, const Camera& camera, int layers,
                     const CastOptions& options = {}) {
  LayeredFrame frame(camera.width, camera.height, layers);
  cast_layers(structure, camera, frame, options);
  return frame;
}

LayeredFrame raster_of(const TriangleMesh& mesh, const Camera& camera, int layers,
                       const RasterOptions& options = {}) {
  LayeredFrame frame(camera.width, camera.height, layers);
  rasterize_layers(mesh, camera, frame, options);
  return frame;
}

std::vector<Structure> every_structure(const TriangleMesh& mesh) {
  std::vector<Structure> structures = structures_of_cells(mesh);
  structures.emplace_back(BruteForce(mesh));
  for (const int width : {2, 4, 8}) {
    BuildOptions options;
    options.width = width;
    structures.emplace_back(Bvh(mesh, options));
    options.quality = Quality::Best;
    structures.emplace_back(Bvh(mesh, options));
  }
  BuildOptions options;
  options.compact = true;
  structures.emplace_back(Bvh(mesh, options));
  return structures;
}

// A cloud of small triangles, some doubled, some without area, some not finite, the camera in their midst.
TriangleMesh mixed_mesh() {
  hard::Random random(7);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < 600; ++i) {
    const glm::vec3 centre = 4.0f * random.unit3();
    for (int v = 0; v < 3; ++v) mesh.positions.push_back(centre + random.unit3());
    mesh.triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
    if (i % 5 == 0) mesh.triangles.emplace_back(3 * i + 2, 3 * i, 3 * i + 1);
    if (i % 7 == 0) mesh.triangles.emplace_back(3 * i, 3 * i, 3 * i + 1);
    if (i % 50 == 0) mesh.positions[3 * i].y = std::numeric_limits<float>::quiet_NaN();
  }
  return mesh;
}

}  // namespace

TEST_SUITE("layers: oracle") {
  TEST_CASE("layers of hard views are the oracle's, on every instruction set and any threads") {
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 5);
    std::size_t turn = 0, taken = 0, second = 0, run = 0;
    for (const hard::View& view : hard::views()) {
      ++turn;
      if (turn % (2 * hard::kEffortDivisor) != 0) continue;
      CAPTURE(view.name);
      const int layers = 1 + static_cast<int>(taken++ % 4);
      const LayeredFrame expected = oracle_layers(view.mesh, view.camera, layers);
      CHECK(hard::difference(expected.layer(0), view.expected) == "");
      if (layers > 1) {
        const Frame behind = expected.layer(1);
        second += static_cast<std::size_t>(
            std::count_if(behind.id.begin(), behind.id.end(), [](std::uint32_t id) { return id != kNone; }));
      }
      for (const Simd simd : simd_targets()) {
        CAPTURE(simd_name(simd));
        RasterOptions raster;
        raster.simd = simd;
        raster.threads = kThreads[run++ % 3];
        CHECK(difference(raster_of(view.mesh, view.camera, layers, raster), expected) == "");
        BuildOptions build;
        build.simd = simd;
        build.width = run % 2 == 0 ? 4 : 8;
        CastOptions cast;
        cast.threads = raster.threads;
        CHECK(difference(cast_of(Bvh(view.mesh, build), view.camera, layers, cast), expected) == "");
      }
    }
    CHECK(second > 1000 / hard::kEffortDivisor);
  }

  TEST_CASE("every structure has the first of all hits, and triangles do") {
    for (const char* name : {"soup:300", "ties:256", "grid:8", "quads:20", "cornell:32", "grass:300"}) {
      CAPTURE(name);
      const BuiltinScene scene = builtin_scene(name);
      const Camera camera = scene.camera(37, 29);
      for (const int layers : {1, 3, 40}) {
        CAPTURE(layers);
        const LayeredFrame expected = brute_layers(scene.mesh, camera, layers);
        CHECK(difference(raster_of(scene.mesh, camera, layers), expected) == "");
        for (const Structure& structure : every_structure(scene.mesh))
          CHECK(difference(cast_of(structure, camera, layers), expected) == "");
      }
    }
  }

  TEST_CASE("from inside a cloud with doubled, flat and non-finite triangles") {
    const TriangleMesh mesh = mixed_mesh();
    const Camera camera = Camera::look_at({0, 0, 0}, {1, 0.25f, 0.5f}, {0, 1, 0}, 100.0, 70, 50);
    const LayeredFrame expected = brute_layers(mesh, camera, 6);
    CHECK(expected.id.back() != 0);
    for (const Structure& structure : every_structure(mesh))
      CHECK(difference(cast_of(structure, camera, 6), expected) == "");
    for (const Simd simd : simd_targets()) {
      CAPTURE(simd_name(simd));
      RasterOptions options;
      options.simd = simd;
      CHECK(difference(raster_of(mesh, camera, 6, options), expected) == "");
    }
  }

  TEST_CASE("parts in any order, some of them twice, make the layers of the whole") {
    const BuiltinScene scene = builtin_scene("ties:1000");
    const Camera camera = scene.camera(90, 70);
    const LayeredFrame expected = cast_of(Bvh(scene.mesh), camera, 5);
    const std::span<const glm::uvec3> triangles = scene.mesh.triangles;
    hard::Random random(3);
    std::vector<std::size_t> starts;
    for (std::size_t first = 0; first < triangles.size(); first += 100) starts.push_back(first);
    starts.insert(starts.end(), {0, 300});
    random.shuffle(starts);
    LayeredFrame frame(90, 70, 5);
    for (const std::size_t first : starts) {
      RasterOptions options;
      options.first_id = static_cast<std::uint32_t>(first);
      const std::size_t count = std::min<std::size_t>(100, triangles.size() - first);
      rasterize_layers(MeshView(scene.mesh.positions, triangles.subspan(first, count)), camera, frame,
                       options);
    }
    CHECK(difference(frame, expected) == "");
  }

  TEST_CASE("a camera that sees nothing leaves nothing") {
    const TriangleMesh mesh = mixed_mesh();
    Camera camera({std::numeric_limits<float>::infinity(), 0, 0}, {-1, -1, 1}, {0.1, 0, 0}, {0, 0.1, 0}, 20,
                  20);
    const LayeredFrame nothing(20, 20, 3);
    CHECK(difference(raster_of(mesh, camera, 3), nothing) == "");
    CHECK(difference(cast_of(Bvh(mesh), camera, 3), nothing) == "");
    camera.eye = {0, 0, 0};
    camera.du = {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    CHECK(difference(raster_of(mesh, camera, 3), nothing) == "");
    CHECK(difference(cast_of(Bvh(mesh), camera, 3), nothing) == "");
  }
}
