// k-buffers by rays and by triangles: a pixel's entries are the first of what its ray meets.

#include "plumb/layers.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "plumb/brute_force.h"
#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/octree.h"
#include "plumb/raster.h"
#include "support/effort.h"
#include "support/hard_scenes.h"
#include "support/random.h"

using namespace plumb;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// By what every ray meets in full.
LayeredFrame expected_layers(const TriangleMesh& mesh, const Camera& camera, int layers,
                             std::uint32_t first_id = 0) {
  const BruteForce brute(mesh, first_id);
  LayeredFrame frame(camera.width, camera.height, layers);
  std::vector<Hit> hits;
  std::size_t entry = 0;
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      brute.all(camera.ray(x, y), hits);
      for (std::size_t k = 0; k < static_cast<std::size_t>(layers); ++k, ++entry) {
        if (k >= hits.size()) continue;
        frame.depth[entry] = hits[k].t;
        frame.id[entry] = hits[k].id;
      }
    }
  }
  return frame;
}

bool equal(const LayeredFrame& a, const LayeredFrame& b) {
  const auto same_bits = [](float s, float t) {
    return std::bit_cast<std::uint32_t>(s) == std::bit_cast<std::uint32_t>(t);
  };
  return a.width == b.width && a.height == b.height && a.layers == b.layers && a.id == b.id &&
         std::equal(a.depth.begin(), a.depth.end(), b.depth.begin(), b.depth.end(), same_bits);
}

LayeredFrame spoiled(const Camera& camera, int layers) {
  LayeredFrame frame(camera.width, camera.height, layers);
  std::fill(frame.depth.begin(), frame.depth.end(), 1e-30f);
  std::fill(frame.id.begin(), frame.id.end(), 5u);
  return frame;
}

LayeredFrame by_rays(const Structure& structure, const Camera& camera, int layers, Simd simd, int threads) {
  LayeredFrame frame = spoiled(camera, layers);
  CastOptions options;
  options.simd = simd;
  options.threads = threads;
  cast_layers(structure, camera, frame, options);
  return frame;
}

LayeredFrame by_triangles(MeshView mesh, const Camera& camera, int layers, Simd simd, int threads) {
  LayeredFrame frame = spoiled(camera, layers);
  RasterOptions options;
  options.simd = simd;
  options.threads = threads;
  options.overwrite = true;
  rasterize_layers(mesh, camera, frame, options);
  return frame;
}

// A view from inside or outside of the mesh.
Camera random_camera(hard::Random& random, const TriangleMesh& mesh) {
  glm::vec3 target(0);
  for (int tries = 0; tries < 8; ++tries) {
    const glm::vec3& p = mesh.positions[random.below(static_cast<std::uint32_t>(mesh.positions.size()))];
    if (std::abs(p.x) < 1e6f && std::abs(p.y) < 1e6f && std::abs(p.z) < 1e6f) target = p;
  }
  const glm::vec3 eye = target + random.unit3() * (random.one_in(2) ? 0.5f : 4.0f);
  return Camera::look_at(eye, target, {0.01f, 1.0f, 0.02f}, 60.0, random.between(1, 50),
                         random.between(1, 40));
}

}  // namespace

TEST_SUITE("layers") {
  TEST_CASE("rays and triangles find the first surfaces, on every instruction set") {
    const TriangleMesh mesh = builtin_scene("soup:300").mesh;
    const Camera camera = Camera::look_at({0.4f, 0.5f, 1.6f}, {0, 0, 0}, {0.01f, 1, 0.02f}, 60.0, 71, 45);
    const Bvh bvh(mesh);
    for (const int layers : {1, 2, 5, 40}) {
      CAPTURE(layers);
      const LayeredFrame expected = expected_layers(mesh, camera, layers);
      CHECK(std::count(expected.id.begin(), expected.id.end(), kNone) <
            static_cast<std::ptrdiff_t>(expected.id.size()));
      for (const Simd simd : simd_targets()) {
        for (const int threads : {1, 3}) {
          CHECK(equal(by_rays(bvh, camera, layers, simd, threads), expected));
          CHECK(equal(by_triangles(mesh, camera, layers, simd, threads), expected));
        }
      }
    }
  }

  TEST_CASE("the first layer is the frame") {
    const TriangleMesh mesh = builtin_scene("grid:12").mesh;
    const Camera camera = frame_all(mesh, 90, 70);
    Frame frame(90, 70);
    cast(Bvh(mesh), camera, frame);
    const LayeredFrame layered = by_triangles(mesh, camera, 3, Simd::Auto, 0);
    CHECK(compare(layered.layer(0), frame).equal());
    CHECK_FALSE(compare(layered.layer(1), frame).equal());
  }

  TEST_CASE("hard scenes: ties, edges, slivers, what is not finite") {
    hard::Random random(11);
    for (const hard::SceneKind& kind : hard::scene_kinds()) {
      CAPTURE(kind.name);
      for (int i = 0; i < hard::effort(30); ++i) {
        const TriangleMesh mesh = kind.make(random);
        if (mesh.positions.empty()) continue;
        const Camera camera = random_camera(random, mesh);
        const int layers = random.between(1, 9);
        const LayeredFrame expected = expected_layers(mesh, camera, layers);
        const std::vector<Simd> targets = simd_targets();
        const Simd simd = targets[random.below(static_cast<std::uint32_t>(targets.size()))];
        CHECK(equal(by_rays(Bvh(mesh), camera, layers, simd, 2), expected));
        CHECK(equal(by_rays(Octree(mesh), camera, layers, simd, 1), expected));
        CHECK(equal(by_triangles(mesh, camera, layers, simd, 2), expected));
      }
    }
  }

  TEST_CASE("parts drawn in any order, and drawn twice, give the whole") {
    const TriangleMesh mesh = builtin_scene("soup:300").mesh;
    const Camera camera = Camera::look_at({0.4f, 0.5f, 1.6f}, {0, 0, 0}, {0.01f, 1, 0.02f}, 60.0, 50, 40);
    const LayeredFrame expected = expected_layers(mesh, camera, 4, 70);
    LayeredFrame frame(50, 40, 4);
    for (const std::size_t first : {200u, 0u, 100u, 0u}) {
      const MeshView part(mesh.positions, std::span<const glm::uvec3>(mesh.triangles).subspan(first, 100));
      RasterOptions options;
      options.first_id = 70 + static_cast<std::uint32_t>(first);
      rasterize_layers(part, camera, frame, options);
    }
    CHECK(equal(frame, expected));
  }

  TEST_CASE("nothing to see") {
    const TriangleMesh none, some = builtin_scene("grid:4").mesh;
    Camera camera = frame_all(some, 20, 15);
    const LayeredFrame clear(20, 15, 3);
    CHECK(equal(by_triangles(none, camera, 3, Simd::Auto, 0), clear));
    CHECK(equal(by_rays(Bvh(none), camera, 3, Simd::Auto, 0), clear));
    camera.eye.z = kInfinity;
    CHECK(equal(by_triangles(some, camera, 3, Simd::Auto, 0), clear));
    CHECK(equal(by_rays(Bvh(some), camera, 3, Simd::Auto, 0), clear));
  }

  TEST_CASE("what cannot be is an error that says so, and cancelling takes everything back") {
    CHECK_THROWS_WITH_AS(LayeredFrame(4, 4, 0), doctest::Contains("layers from 1"), Error);
    CHECK_THROWS_AS(LayeredFrame(0, 4, 1), Error);
    CHECK_THROWS_AS(LayeredFrame(4, 4, LayeredFrame::kMostLayers + 1), Error);
    CHECK_THROWS_WITH_AS(LayeredFrame(4, 4, 2).layer(2), doctest::Contains("layers 0 to 1"), Error);
    const TriangleMesh mesh = builtin_scene("grid:4").mesh;
    const Camera camera = frame_all(mesh, 40, 35);
    LayeredFrame other(41, 35, 2), short_one(40, 35, 2);
    short_one.id.pop_back();
    for (LayeredFrame* frame : {&other, &short_one}) {
      CHECK_THROWS_AS(cast_layers(Bvh(mesh), camera, *frame), Error);
      CHECK_THROWS_AS(rasterize_layers(mesh, camera, *frame), Error);
    }
    LayeredFrame frame = spoiled(camera, 2);
    RasterOptions options;
    options.overwrite = true;
    options.progress = [](double) { return false; };
    CHECK_THROWS_AS(rasterize_layers(mesh, camera, frame, options), Cancelled);
    CHECK(equal(frame, spoiled(camera, 2)));
    CastOptions cast_options;
    cast_options.progress = options.progress;
    CHECK_THROWS_AS(cast_layers(Bvh(mesh), camera, frame, cast_options), Cancelled);
  }
}
