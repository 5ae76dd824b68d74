// Tiles of large scenes against rays and the rasterizer, bit for bit: built-in and shared scenes, trees of
// every quality and both widths, every instruction set, one to four threads, cameras that are hard for
// culling.

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <oneapi/tbb/global_control.h>
#include <glm/common.hpp>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/frame.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shared_data.h"

using namespace plumb;

namespace {

struct NamedCamera {
  std::string name;
  Camera camera;
};

struct Bounds {
  glm::vec3 lo, hi;

  explicit Bounds(const TriangleMesh& mesh) : lo(mesh.positions.front()), hi(lo) {
    for (const glm::vec3& p : mesh.positions) {
      if (!std::isfinite(p.x + p.y + p.z)) continue;
      lo = glm::min(lo, p);
      hi = glm::max(hi, p);
    }
  }
  glm::vec3 middle() const { return 0.5f * lo + 0.5f * hi; }
  float size() const { return std::max({hi.x - lo.x, hi.y - lo.y, hi.z - lo.z}); }
};

// Inside, on a vertex, along a triangle's plane, near a surface, far away, from within the plane of a face of
// the scene's box, beside it and looking away.
std::vector<NamedCamera> hard_cameras(const TriangleMesh& mesh, hard::Random& random) {
  const Bounds box(mesh);
  const glm::vec3 up(0.01f, 1.0f, 0.02f);
  const float size = box.size();
  std::vector<NamedCamera> cameras;
  const auto add = [&](const char* name, const glm::vec3& eye, const glm::vec3& target, double fov, int width,
                       int height) {
    if (target != eye) cameras.push_back({name, Camera::look_at(eye, target, up, fov, width, height)});
  };
  const auto below = [&](std::size_t count) { return random.below(static_cast<std::uint32_t>(count)); };
  const glm::uvec3 corners = mesh.triangles[below(mesh.triangles.size())];
  const glm::vec3 v0 = mesh.positions[corners.x], v1 = mesh.positions[corners.y],
                  v2 = mesh.positions[corners.z];
  const glm::vec3 middle = box.middle();
  add("inside", middle, middle + random.unit3() * size, 75.0, 97, 65);
  add("a vertex", v0, v1, 90.0, 33, 31);
  add("a plane", v0 - (v1 - v0) - (v2 - v0), v0 + (v1 - v0) * 0.3f, 20.0, 64, 32);
  add("near a surface", v0 + random.unit3() * (1e-5f * size), v0, 100.0, 31, 70);
  add("far away", middle + random.unit3() * (3e4f * size), middle, 0.004, 63, 65);
  add("a face of the box", {box.lo.x, middle.y, middle.z}, middle + random.unit3() * (0.3f * size), 60.0, 1,
      97);
  add("outside", middle + glm::vec3(0.3f, 0.8f, 1.3f) * size, middle, 50.0, 129, 95);
  add("looking away", middle + glm::vec3(0.0f, 0.0f, 1.5f) * size,
      middle + glm::vec3(0.2f, 0.1f, 4.0f) * size, 60.0, 65, 33);
  return cameras;
}

void check_equal(const Frame& expected, const Frame& frame) {
  CHECK(compare(expected, frame).different_pixels == 0);
}

// Every tree and instruction set where `all`, else each tree with one of them in turn.
void check_tiles(const TriangleMesh& mesh, const std::vector<NamedCamera>& cameras, bool all) {
  std::vector<Frame> expected;
  std::vector<Bvh> trees;
  for (const Quality quality : {Quality::Fast, Quality::Balanced, Quality::Best}) {
    for (const int width : {4, 8}) {
      BuildOptions build;
      build.quality = quality;
      build.width = width;
      trees.emplace_back(mesh, build);
    }
  }
  for (const NamedCamera& view : cameras) {
    CAPTURE(view.name);
    const Camera& camera = view.camera;
    Frame drawn(camera.width, camera.height), by_rays(camera.width, camera.height);
    rasterize(mesh, camera, drawn);
    cast(trees[3], camera, by_rays, {.method = CastMethod::Rays});
    check_equal(by_rays, drawn);
    CastOptions options;
    options.threads = 1;
    options.method = CastMethod::Tiles;
    const std::vector<Simd> targets = simd_targets();
    for (std::size_t tree = 0; tree < trees.size(); ++tree) {
      CAPTURE(tree);
      for (std::size_t i = 0; i < targets.size(); ++i) {
        if (!all && i != tree % targets.size()) continue;
        CAPTURE(simd_name(targets[i]));
        CAPTURE(options.threads);
        options.simd = targets[i];
        Frame frame(camera.width, camera.height);
        cast(trees[tree], camera, frame, options);
        check_equal(by_rays, frame);
        options.threads = options.threads % 4 + 1;
      }
    }
  }
}

// The mesh about `centre`, its size times `scale`, rounded to floats again.
TriangleMesh moved(TriangleMesh mesh, float scale, const glm::vec3& centre) {
  for (glm::vec3& p : mesh.positions) p = p * scale + centre;
  return mesh;
}

}  // namespace

TEST_SUITE("agree: tiles") {
  TEST_CASE("built-in scenes from hard cameras") {
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 4);
    hard::Random random(1);
    for (const BuiltinInfo& info : builtin_scenes()) {
      CAPTURE(info.name);
      const std::size_t size = info.default_size > 50'000 ? info.default_size / 10 : info.default_size;
      const BuiltinScene scene = builtin_scene(info.name + ":" + std::to_string(size));
      std::vector<NamedCamera> cameras = hard_cameras(scene.mesh, random);
      cameras.push_back({"the scene's own", scene.camera(157, 83)});
      check_tiles(scene.mesh, cameras, hard::kEffortDivisor == 1);
    }
  }

  TEST_CASE("coordinates huge, tiny and far from the origin beside the scene's size") {
    hard::Random random(2);
    const TriangleMesh mesh = builtin_scene("spheres:3000").mesh;
    const float size = Bounds(mesh).size();
    struct {
      float scale;
      glm::vec3 centre;
    } const places[] = {{1.0f, glm::vec3(1e5f, -3e4f, 2e5f)},
                        {0x1p-10f, glm::vec3(1.0f, 2.0f, -3.0f) * size},
                        {0x1p50f, glm::vec3(0.0f)},
                        {0x1p59f, glm::vec3(0.0f)},  // about where tiles give up and rays are cast
                        {0x1p62f, glm::vec3(0.0f)},
                        {0x1p100f, glm::vec3(0.0f)},
                        {0x1p-60f, glm::vec3(0.0f)},
                        {0x1p-120f, glm::vec3(0.0f)}};
    for (const auto& place : places) {
      CAPTURE(place.scale);
      const TriangleMesh there = moved(mesh, place.scale, place.centre);
      check_tiles(there, hard_cameras(there, random), true);
    }
  }

  TEST_CASE("trees that followed moved vertices") {
    hard::Random random(4);
    const TriangleMesh mesh = builtin_scene("spheres:3000").mesh;
    for (const Quality quality : {Quality::Fast, Quality::Best}) {
      BuildOptions build;
      build.quality = quality;
      Bvh bvh(mesh, build);
      // Farther from the origin than the tree was built for, and bent.
      TriangleMesh bent = moved(mesh, 3.0f, glm::vec3(50.0f, -20.0f, 10.0f));
      for (glm::vec3& p : bent.positions) p.x += 0.2f * p.y * std::sin(p.z);
      bvh.refit(bent);
      for (const NamedCamera& view : hard_cameras(bent, random)) {
        CAPTURE(view.name);
        Frame drawn(view.camera.width, view.camera.height), frame = drawn;
        rasterize(bent, view.camera, drawn);
        cast(bvh, view.camera, frame, {.method = CastMethod::Tiles});
        check_equal(drawn, frame);
      }
    }
  }

  TEST_CASE("the shared scenes") {
    PLUMB_REQUIRE_SHARED();
    hard::Random random(3);
    for (const std::string& scene : shared::scenes()) {
      CAPTURE(scene);
      const TriangleMesh mesh = shared::load_scene(scene);
      // Under the sanitizers they take minutes.
      if (hard::kEffortDivisor > 1 && mesh.triangles.size() > 40000) continue;
      std::vector<NamedCamera> cameras = hard_cameras(mesh, random);
      for (const shared::View& view : shared::views_of(scene)) {
        cameras.push_back(
            {view.name, Camera::look_at(view.eye, view.target, view.up, view.fov_y_degrees, 417, 235)});
      }
      check_tiles(mesh, cameras, false);
    }
  }
}
