#include <fstream>
#include <limits>
#include <string>

#include <doctest/doctest.h>
#include <glm/vec3.hpp>

#include "plumb/builtin.h"
#include "plumb/error.h"
#include "scene.h"
#include "text.h"
#include "tool/run_tool.h"

using plumb::Camera;
using plumb::tool::FrameOptions;
using plumb::tool::open_scene;

namespace {

bool same(const Camera& a, const Camera& b) {
  return a.eye == b.eye && a.corner == b.corner && a.du == b.du && a.dv == b.dv && a.width == b.width &&
         a.height == b.height;
}

FrameOptions small_grid() {
  FrameOptions options;
  options.scene = "builtin:grid:2";
  options.size = "64x32";
  return options;
}

const char* const kTriangle = "v 0 0 0\nv 4 0 0\nv 0 2 0\nv nan 9 9\nf 1 2 3\nf 1 2 4\n";

}  // namespace

TEST_SUITE_BEGIN("tool: scene and camera");

TEST_CASE("decimal text is rounded once to the nearest float") {
  CHECK(plumb::tool::parse_vec3("--eye", "0.1,-16777217,1e-46") == glm::vec3(0.1f, -16777216.0f, 0.0f));
  CHECK(plumb::tool::parse_vec3("--eye", "1.4e-45,3.4028235e38,-0").x ==
        std::numeric_limits<float>::denorm_min());
  // A bit above the midpoint of 1 and the next float: rounding to double first would lose it.
  CHECK(plumb::tool::parse_vec3("--eye", "1.00000005960464477539062500001,0,0").x ==
        1.00000011920928955078125f);
}

TEST_CASE("lists and sizes are read strictly") {
  CHECK(plumb::tool::split_list("a,,b") == std::vector<std::string>{"a", "", "b"});
  CHECK(plumb::tool::parse_size("--size", "1x65535") == std::pair(1, 65535));
  for (const char* text :
       {"", "x", "1x", "x1", "1x1 ", " 1x1", "+1x1", "1X1", "1x0", "1x-1", "1.5x1", "65536x1"}) {
    CAPTURE(text);
    CHECK_THROWS_AS(plumb::tool::parse_size("--size", text), plumb::Error);
  }
}

TEST_CASE("without camera options a built-in scene brings its own camera") {
  CHECK(same(open_scene(small_grid()).camera, plumb::builtin_scene("grid:2").camera(64, 32)));
}

TEST_CASE("each camera option replaces that part of a built-in scene's camera alone") {
  const plumb::BuiltinScene own = plumb::builtin_scene("grid:2");
  FrameOptions options = small_grid();
  options.eye = "1,2,3";
  CHECK(same(open_scene(options).camera,
             Camera::look_at({1, 2, 3}, own.target, own.up, own.fov_y_degrees, 64, 32)));
  options = small_grid();
  options.target = "1,2,3";
  CHECK(same(open_scene(options).camera,
             Camera::look_at(own.eye, {1, 2, 3}, own.up, own.fov_y_degrees, 64, 32)));
  options = small_grid();
  options.up = "1,2,3";
  options.fov = 17.5;
  CHECK(same(open_scene(options).camera, Camera::look_at(own.eye, own.target, {1, 2, 3}, 17.5, 64, 32)));
}

TEST_CASE("a file's camera frames all of it, and camera options replace its parts") {
  const plumb::test::TempFolder folder;
  FrameOptions options;
  options.scene = (folder / "one.obj").string();
  options.size = "64x32";
  std::ofstream(options.scene) << kTriangle;
  const plumb::tool::Scene scene = open_scene(options);
  const Camera all = plumb::frame_all(scene.mesh, 64, 32);
  CHECK(same(scene.camera, all));

  options.fov = 25.0;
  CHECK(same(open_scene(options).camera, plumb::frame_all(scene.mesh, 64, 32, 25.0)));
  options.fov.reset();
  // The middle of the finite triangles is (2, 1, 0).
  options.eye = "0,0,9";
  CHECK(same(open_scene(options).camera, Camera::look_at({0, 0, 9}, {2, 1, 0}, {0, 1, 0}, 40.0, 64, 32)));
  options.eye.reset();
  options.target = "4,0,0";
  CHECK(same(open_scene(options).camera, Camera::look_at(all.eye, {4, 0, 0}, {0, 1, 0}, 40.0, 64, 32)));
}

TEST_CASE("looking straight down needs no --up") {
  FrameOptions options = small_grid();
  options.eye = "1,9,2";
  options.target = "1,3,2";
  const double fov = plumb::builtin_scene("grid:2").fov_y_degrees;
  CHECK(same(open_scene(options).camera, Camera::look_at({1, 9, 2}, {1, 3, 2}, {0, 0, -1}, fov, 64, 32)));
}

TEST_SUITE_END();
