#include "plumb/visible.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/kd_tree.h"
#include "plumb/raster.h"

using namespace plumb;

namespace {

Camera camera_towards(const glm::vec3& eye, int width, int height) {
  return Camera::look_at(eye, {0.1f, 0.0f, 0.05f}, {0.01f, 1.0f, 0.02f}, 60.0, width, height);
}

// A frame full of what no one sees.
Frame spoiled(int width, int height) {
  Frame frame(width, height);
  std::fill(frame.depth.begin(), frame.depth.end(), 1e-30f);
  std::fill(frame.id.begin(), frame.id.end(), 7u);
  return frame;
}

Frame cast_frame(const Structure& structure, const Camera& camera) {
  Frame frame(camera.width, camera.height);
  CastOptions options;
  options.method = CastMethod::Rays;
  cast(structure, camera, frame, options);
  return frame;
}

}  // namespace

TEST_SUITE("visible") {
  TEST_CASE("without a structure triangles are drawn, and the frame is overwritten") {
    const TriangleMesh mesh = builtin_scene("grid:40").mesh;
    const Camera camera = camera_towards({1.5f, 0.7f, 2.5f}, 83, 61);
    Frame frame = spoiled(83, 61);
    const VisibleChoice choice = visible(mesh, camera, frame);
    CHECK(choice.method == VisibleMethod::Raster);
    CHECK_FALSE(choice.reason.empty());
    CHECK(compare(frame, cast_frame(Bvh(mesh), camera)).equal());
  }

  TEST_CASE("every way is taken, with the same bits on every instruction set and number of threads") {
    const TriangleMesh dense = builtin_scene("terrain:30000").mesh;
    const TriangleMesh sparse = builtin_scene("grid:10").mesh;
    struct {
      const TriangleMesh& mesh;
      bool rays_only;
      int width, height;
      VisibleMethod method;
    } const cases[] = {{dense, false, 200, 150, VisibleMethod::Raster},  // small triangles, all in view
                       {dense, false, 64, 48, VisibleMethod::Rays},      // many for each pixel
                       {sparse, false, 120, 90, VisibleMethod::Tiles},
                       {sparse, false, 700, 500, VisibleMethod::Raster},  // a few triangles to a tile
                       {dense, true, 40, 30, VisibleMethod::Rays},
                       {sparse, true, 120, 90, VisibleMethod::Raster}};
    for (const auto& test : cases) {
      const Camera camera = frame_all(test.mesh, test.width, test.height);
      const Bvh bvh(test.mesh);
      const Structure structure = test.rays_only ? Structure(KdTree(test.mesh)) : Structure(bvh);
      const Frame expected = cast_frame(bvh, camera);
      CHECK(choose_visible(test.mesh, &structure, camera).method == test.method);
      for (const Simd simd : simd_targets()) {
        for (const int threads : {1, 3}) {
          Frame frame = spoiled(test.width, test.height);
          VisibleOptions options;
          options.simd = simd;
          options.threads = threads;
          const VisibleChoice choice = visible(test.mesh, structure, camera, frame, options);
          CHECK(choice.method == test.method);
          CHECK(compare(frame, expected).equal());
        }
      }
    }
  }

  TEST_CASE("ids begin where they are told to") {
    const TriangleMesh mesh = builtin_scene("grid:10").mesh;
    const Camera camera = frame_all(mesh, 50, 40);
    BuildOptions build;
    build.first_id = 1000;
    const Bvh bvh(mesh, build);
    VisibleOptions options;
    options.first_id = 1000;
    Frame drawn(50, 40), cast_through(50, 40);
    visible(mesh, camera, drawn, options);
    visible(mesh, bvh, camera, cast_through, options);
    CHECK(compare(drawn, cast_through).equal());
    CHECK(std::count_if(drawn.id.begin(), drawn.id.end(),
                        [](std::uint32_t id) { return id != kNone && id < 1000; }) == 0);
    CHECK(std::count(drawn.id.begin(), drawn.id.end(), kNone) < 50 * 40);
  }

  TEST_CASE("an empty mesh, and an eye that is nowhere, see nothing") {
    const TriangleMesh none;
    const TriangleMesh some = builtin_scene("grid:4").mesh;
    const Bvh empty(none), full(some);
    Camera nowhere = camera_towards({1, 1, 2}, 33, 35);
    nowhere.eye.x = std::numeric_limits<float>::quiet_NaN();
    const auto sees_nothing = [](const Frame& frame) {
      return compare(frame, Frame(frame.width, frame.height)).equal();
    };
    const Camera camera = camera_towards({1, 1, 2}, 33, 35);
    Frame frame = spoiled(33, 35);
    visible(none, camera, frame);
    CHECK(sees_nothing(frame));
    frame = spoiled(33, 35);
    visible(none, empty, camera, frame);
    CHECK(sees_nothing(frame));
    frame = spoiled(33, 35);
    visible(some, nowhere, frame);
    CHECK(sees_nothing(frame));
    frame = spoiled(33, 35);
    visible(some, full, nowhere, frame);
    CHECK(sees_nothing(frame));
  }

  TEST_CASE("what cannot be is an error that says so") {
    const TriangleMesh mesh = builtin_scene("grid:4").mesh;
    const Camera camera = frame_all(mesh, 20, 20);
    Frame frame(20, 20), other(21, 20);
    CHECK_THROWS_WITH_AS(visible(mesh, Bvh(builtin_scene("grid:5").mesh), camera, frame),
                         doctest::Contains("hand over the one built for this mesh"), Error);
    CHECK_THROWS_AS(visible(mesh, camera, other), Error);
    TriangleMesh broken = mesh;
    broken.triangles[0].x = 1u << 30;
    CHECK_THROWS_AS(visible(broken, camera, frame), Error);
    const Bvh bvh(mesh);
    CHECK_THROWS_WITH_AS(choose_visible(broken, &bvh, camera), doctest::Contains("triangle 0"), Error);
  }

  TEST_CASE("names") {
    CHECK(std::string(visible_method_name(VisibleMethod::Raster)) == "raster");
    CHECK(std::string(visible_method_name(VisibleMethod::Tiles)) == "tiles");
    CHECK(std::string(visible_method_name(VisibleMethod::Rays)) == "rays");
  }
}
