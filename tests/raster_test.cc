#include "plumb/raster.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "plumb/simd.h"
#include "raster_util.h"
#include "support/effort.h"
#include "support/hard_cameras.h"
#include "support/hard_scenes.h"

// Frames of the rasterizer against a plain loop over pixels and triangles in exact arithmetic.

using namespace plumb;
using namespace plumb::raster_test;

namespace {

constexpr std::uint64_t kSeeds = hard::effort(std::uint64_t{8});

struct View {
  std::string name;
  TriangleMesh mesh;
  Camera camera;
  Frame expected;
};

View make_view(std::string name, TriangleMesh mesh, const Camera& camera) {
  Frame expected = brute_force_frame(mesh, camera);
  return {std::move(name), std::move(mesh), camera, std::move(expected)};
}

// Every kind of camera on every kind of scene, `seeds` times.
std::vector<View> hard_views(std::uint64_t seeds) {
  std::vector<View> views;
  std::uint64_t seed = 1000;
  for (std::uint64_t repeat = 0; repeat < seeds; ++repeat) {
    for (const hard::SceneKind& scene : hard::scene_kinds()) {
      for (const hard::CameraKind& kind : hard::camera_kinds()) {
        ++seed;
        hard::Random random(seed);
        TriangleMesh mesh = scene.make(random);
        const Camera camera = kind.make(random, mesh);
        views.push_back(make_view(
            std::string(scene.name) + " from " + std::string(kind.name) + ", seed " + std::to_string(seed),
            std::move(mesh), camera));
      }
    }
  }
  return views;
}

void check_view(const View& view, Simd simd, int threads) {
  CAPTURE(view.name);
  CAPTURE(simd_name(simd));
  CAPTURE(threads);
  RasterOptions options;
  options.simd = simd;
  options.threads = threads;
  check_frame(raster_frame(view.mesh, view.camera, options), view.expected);
}

// On every target, with one to four threads.
void check_view(const View& view) {
  const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 4);
  int threads = static_cast<int>(view.mesh.triangles.size() % 4);
  for (const Simd simd : simd_targets()) {
    threads = threads % 4 + 1;
    check_view(view, simd, threads);
  }
}

void add_triangle(TriangleMesh& mesh, glm::vec3 v0, glm::vec3 v1, glm::vec3 v2) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {v0, v1, v2});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
}

// Frames of several tiles, so that whole tiles are inside and outside.
Camera wide_camera(glm::vec3 eye, glm::vec3 target, int width = 131, int height = 77) {
  return Camera::look_at(eye, target, {0.0f, 1.0f, 0.0f}, 60.0, width, height);
}

// `count` triangles in the cube of side 2 about the origin, each of about `size`.
TriangleMesh cloud(hard::Random& random, int count, float size) {
  TriangleMesh mesh;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 centre = random.unit3();
    const auto corner = [&] { return centre + size * random.unit3(); };
    const glm::vec3 v0 = corner(), v1 = corner(), v2 = corner();
    add_triangle(mesh, v0, v1, v2);
  }
  return mesh;
}

}  // namespace

TEST_SUITE("raster: answers") {
  TEST_CASE("hard scenes from hard cameras are seen as single rays see them, on every target") {
    std::size_t hits = 0, pixels = 0;
    for (const View& view : hard_views(kSeeds)) {
      check_view(view);
      pixels += view.expected.id.size();
      for (const std::uint32_t id : view.expected.id) hits += id != kNone ? 1 : 0;
    }
    CHECK(hits > pixels / 5);
    CHECK(hits < pixels * 3 / 4);
  }

  TEST_CASE("triangles of every size, over several tiles, from outside and from among them") {
    hard::Random random(1);
    for (const float size : {0.003f, 0.02f, 0.1f, 0.5f, 3.0f}) {
      CAPTURE(size);
      const TriangleMesh mesh = cloud(random, 150, size);
      check_view(make_view("outside", mesh, wide_camera({0.5f, 1.0f, 3.0f}, {0, 0, 0})));
      check_view(make_view("inside", mesh, wide_camera({0.1f, 0.2f, 0.3f}, {-1, 0, 0}, 97, 33)));
    }
  }

  TEST_CASE("slivers that cross the frame in every direction") {
    hard::Random random(2);
    TriangleMesh mesh;
    for (int i = 0; i < 120; ++i) {
      const glm::vec3 a = random.unit3(), b = random.unit3();
      add_triangle(mesh, a, b, b + 0.01f * random.unit3());
    }
    check_view(make_view("slivers", mesh, wide_camera({0, 0, 2.5f}, {0, 0, 0})));
  }

  TEST_CASE("stacks of equal, coplanar and nearly equal triangles that fill the frame") {
    hard::Random random(3);
    for (const int kind : {0, 1, 2}) {
      CAPTURE(kind);
      TriangleMesh mesh;
      const glm::vec3 v0(-8, -7, 0.25f), v1(9, -6, 0.5f), v2(0.5f, 9, -0.25f);
      for (int i = 0; i < 12; ++i) {
        glm::vec3 p = v0, q = v1, r = v2;
        if (kind == 1) {  // an affine image of the triangle in its own plane, nearly
          p = v0 + 0.25f * random.unit() * (v1 - v0);
          r = v2 + 0.25f * random.unit() * (v2 - v0);
        } else if (kind == 2) {
          p = hard::nudged(random, p, 3);
          q = hard::nudged(random, q, 3);
          r = hard::nudged(random, r, 3);
        }
        add_triangle(mesh, p, q, r);
      }
      check_view(make_view("stack", mesh, wide_camera({0.25f, 0.125f, 5}, {0, 0, 0})));
    }
  }

  TEST_CASE("layers hide each other whether drawn from the front or from the back") {
    for (const bool front_first : {false, true}) {
      TriangleMesh mesh;
      for (int i = 0; i < 40; ++i) {
        const float z = front_first ? -static_cast<float>(i) : static_cast<float>(i) - 40.0f;
        const float tilt = 0.01f * static_cast<float>(i % 5);
        add_triangle(mesh, {-50, -50, z - tilt}, {90, -45, z + tilt}, {-40, 95, z});
      }
      check_view(make_view("layers", mesh, wide_camera({0, 0, 3}, {0.1f, 0.05f, 0})));
    }
  }

  TEST_CASE("a ground plane through the eye's height, and triangles through the eye") {
    TriangleMesh mesh;
    const glm::vec3 eye(0.25f, 0.5f, 0.75f);
    add_triangle(mesh, {-100, 0, -100}, {100, 0, -100}, {0, 0, 200});       // below, all around
    add_triangle(mesh, {-100, 0.5f, -90}, {100, 0.5f, -90}, {0, 0.5f, 9});  // in the eye's height
    add_triangle(mesh, eye, {1, 2, -5}, {-3, 1, -6});                       // a vertex at the eye
    add_triangle(mesh, {-3, -1, 4}, {-3, 4, -6}, {-3.5f, 4, -6});           // across the eye plane
    add_triangle(mesh, {0.25f, 0.5f, 5.0f}, {0.25f, 0.5f, -5.0f}, {0.5f, 3.0f, -4.0f});  // an edge through it
    for (const glm::vec3 target : {glm::vec3(0, 0, -1), glm::vec3(1, 0.5f, 0.75f), glm::vec3(0, 5, 0.75f)})
      check_view(make_view("ground", mesh, wide_camera(eye, target)));
  }

  TEST_CASE("a height field whose every vertex and diagonal is met by a ray") {
    TriangleMesh mesh;
    constexpr std::uint32_t kSide = 17;
    hard::Random random(4);
    for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
      mesh.positions.emplace_back(static_cast<float>(i % kSide), static_cast<float>(i / kSide),
                                  -static_cast<float>(random.below(2)));
      if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
      mesh.triangles.emplace_back(i, i + 1, i + kSide + 1);
      mesh.triangles.emplace_back(i, i + kSide + 1, i + kSide);
    }
    // Pixel (2i, 2j) looks at the vertex (i, j) where its height is 0.
    const Camera camera({8.0f, 8.0f, 16.0f}, {-8.25, 8.25, -16.0}, {0.5, 0.0, 0.0}, {0.0, -0.5, 0.0}, 35, 35);
    check_view(make_view("grid", mesh, camera));
  }

  TEST_CASE("frames of one pixel, one row, one column, and just around a tile and a block") {
    hard::Random random(5);
    const TriangleMesh mesh = cloud(random, 40, 0.6f);
    for (const auto& [width, height] : std::vector<std::pair<int, int>>{
             {1, 1}, {200, 1}, {1, 200}, {31, 33}, {32, 32}, {33, 31}, {4, 4}, {3, 5}, {65, 64}, {515, 2}}) {
      check_view(make_view(std::to_string(width) + "x" + std::to_string(height), mesh,
                           wide_camera({0, 0.2f, 2.2f}, {0, 0, 0}, width, height)));
    }
  }

  TEST_CASE("triangles so large that they touch most tiles of a frame of many") {
    hard::Random random(7);
    const TriangleMesh mesh = cloud(random, 20, 1.5f);
    check_view(make_view("many tiles", mesh, wide_camera({0, 0.2f, 2.2f}, {0, 0, 0}, 413, 330)));
    check_view(make_view("inside", mesh, wide_camera({0, 0.2f, 0.1f}, {1, 0, 0}, 413, 330)));
  }

  TEST_CASE("scales at which float, or even the bounds, would leave their range") {
    hard::Random random(6);
    const TriangleMesh unit = cloud(random, 30, 0.7f);
    for (const int exponent : {-149, -140, -110, -100, -64, -30, 30, 64, 90, 110, 126}) {
      for (const int direction : {-140, -101, -99, 0, 99, 101, 125}) {
        CAPTURE(exponent);
        CAPTURE(direction);
        TriangleMesh mesh = unit;
        for (glm::vec3& p : mesh.positions)
          p = {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
        const double scale = std::ldexp(1.0, direction);
        const Camera camera({0, 0, std::ldexp(1.5f, exponent)}, scale * glm::dvec3(-0.8, 0.5, -1.0),
                            scale * glm::dvec3(0.043, 0, 0), scale * glm::dvec3(0, -0.042, 0.001), 37, 23);
        const View view = make_view("scaled", mesh, camera);
        check_view(view, Simd::Auto, 1);
        check_view(view, simd_targets().back(), 1);
      }
    }
  }
}
