// Questions about many frames: cast() and rasterize() for many cameras, and who is seen in frames.

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <vector>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/frame.h"
#include "plumb/kd_tree.h"
#include "plumb/raster.h"
#include "plumb/visible_triangles.h"
#include "support/random.h"

using namespace plumb;

namespace {

// Views of very different sizes, one of them from nowhere.
std::vector<Camera> cameras_around() {
  std::vector<Camera> cameras;
  hard::Random random(3);
  for (int i = 0; i < 9; ++i) {
    const int width = i == 2 ? 1 : random.between(1, 90), height = i == 3 ? 1 : random.between(1, 70);
    const glm::vec3 eye = random.unit3() * 3.0f + glm::vec3(0, 0, 1.5f);
    cameras.push_back(Camera::look_at(eye, {0, 0, 0}, {0.01f, 1, 0.02f}, 60.0, width, height));
  }
  cameras[5].eye.y = std::numeric_limits<float>::infinity();
  return cameras;
}

std::vector<Frame> frames_for(const std::vector<Camera>& cameras) {
  std::vector<Frame> frames;
  for (const Camera& camera : cameras) {
    frames.emplace_back(camera.width, camera.height);
    std::fill(frames.back().depth.begin(), frames.back().depth.end(), 1e-30f);
  }
  return frames;
}

std::map<std::uint32_t, std::uint64_t> counted(const std::vector<Frame>& frames) {
  std::map<std::uint32_t, std::uint64_t> counts;
  for (const Frame& frame : frames) {
    for (const std::uint32_t id : frame.id) {
      if (id != kNone) ++counts[id];
    }
  }
  return counts;
}

void check_visible(const std::vector<Frame>& frames) {
  const std::vector<VisibleTriangle> visible = visible_triangles(frames);
  const std::map<std::uint32_t, std::uint64_t> expected = counted(frames);
  REQUIRE(visible.size() == expected.size());
  std::size_t i = 0;
  for (const auto& [id, pixels] : expected) CHECK(visible[i++] == VisibleTriangle{id, pixels});
}

}  // namespace

TEST_SUITE("many frames") {
  TEST_CASE("many cameras give what each gives by itself") {
    const TriangleMesh mesh = builtin_scene("soup:400").mesh;
    const std::vector<Camera> cameras = cameras_around();
    for (const Structure& structure : {Structure(Bvh(mesh)), Structure(KdTree(mesh))}) {
      std::vector<Frame> expected = frames_for(cameras);
      for (std::size_t i = 0; i < cameras.size(); ++i) cast(structure, cameras[i], expected[i]);
      for (const Simd simd : simd_targets()) {
        for (const int threads : {1, 2, 20}) {
          std::vector<Frame> cast_at_once = frames_for(cameras), drawn = frames_for(cameras);
          CastOptions options;
          options.threads = threads;
          options.simd = simd;
          cast(structure, cameras, cast_at_once, options);
          RasterOptions raster;
          raster.threads = threads;
          raster.simd = simd;
          raster.overwrite = true;
          rasterize(mesh, cameras, drawn, raster);
          for (std::size_t i = 0; i < cameras.size(); ++i) {
            CHECK(compare(cast_at_once[i], expected[i]).equal());
            CHECK(compare(drawn[i], expected[i]).equal());
          }
        }
      }
    }
    std::vector<Frame> none;
    cast(Bvh(mesh), std::span<const Camera>(), none);
    rasterize(mesh, std::span<const Camera>(), none);
  }

  TEST_CASE("a frame that does not fit is named, and none is touched") {
    const TriangleMesh mesh = builtin_scene("grid:4").mesh;
    const Bvh bvh(mesh);
    const std::vector<Camera> cameras = cameras_around();
    std::vector<Frame> frames = frames_for(cameras);
    frames[4] = Frame(cameras[4].width + 1, cameras[4].height);
    const std::vector<Frame> before = frames;
    CHECK_THROWS_WITH_AS(cast(bvh, cameras, frames), doctest::Contains("frame 4"), Error);
    CHECK_THROWS_WITH_AS(rasterize(mesh, cameras, frames), doctest::Contains("frame 4"), Error);
    frames.pop_back();
    CHECK_THROWS_WITH_AS(cast(bvh, cameras, frames), doctest::Contains("9 cameras but 8 frames"), Error);
    CHECK_THROWS_WITH_AS(rasterize(mesh, cameras, frames), doctest::Contains("one for each"), Error);
    for (std::size_t i = 0; i < frames.size(); ++i) CHECK(compare(frames[i], before[i]).equal());
  }

  TEST_CASE("progress rises over all frames, and can cancel") {
    const TriangleMesh mesh = builtin_scene("grid:4").mesh;
    const std::vector<Camera> cameras = cameras_around();
    std::vector<Frame> frames = frames_for(cameras);
    double last = 0.0;
    const auto rising = [&](double done) {
      CHECK(done >= last);
      last = done;
      return true;
    };
    CastOptions options;
    options.progress = rising;
    cast(Bvh(mesh), cameras, frames, options);
    CHECK(last == 1.0);
    last = 0.0;
    RasterOptions raster;
    raster.progress = rising;
    rasterize(mesh, cameras, frames, raster);
    CHECK(last == 1.0);
    raster.progress = [](double) { return false; };
    CHECK_THROWS_AS(rasterize(mesh, cameras, frames, raster), Cancelled);
    options.progress = raster.progress;
    CHECK_THROWS_AS(cast(Bvh(mesh), cameras, frames, options), Cancelled);
  }

  TEST_CASE("who is seen, and in how many pixels") {
    const TriangleMesh mesh = builtin_scene("soup:400").mesh;
    const std::vector<Camera> cameras = cameras_around();
    for (const std::uint32_t first_id : {0u, 5'000'000u, kNone - 400}) {
      std::vector<Frame> frames = frames_for(cameras);
      RasterOptions raster;
      raster.first_id = first_id;
      raster.overwrite = true;
      rasterize(mesh, cameras, frames, raster);
      check_visible(frames);
      check_visible({frames[0]});
      CHECK(visible_triangles(frames[0]) == visible_triangles(std::span<const Frame>(frames).first(1)));
    }
    CHECK(visible_triangles(Frame(7, 5)).empty());
    CHECK(visible_triangles(std::span<const Frame>()).empty());
  }
}
