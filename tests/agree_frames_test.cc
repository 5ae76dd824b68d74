#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "oracle/oracle.h"
#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/frame.h"
#include "support/hard_cameras.h"
#include "support/hard_scenes.h"
#include "support/oracle_adapter.h"

// Whole frames of small hard scenes, as hard cameras see them, against the oracle's.

using namespace plumb;

namespace {

struct View {
  std::string name;
  TriangleMesh mesh;
  Camera camera;
  Frame expected;
};

Frame oracle_frame(const TriangleMesh& mesh, const Camera& camera) {
  const oracle::Frame seen =
      oracle::render(oracle::Scene(witness::to_oracle(mesh)), witness::to_oracle(camera));
  Frame frame(camera.width, camera.height);
  for (std::size_t i = 0; i < seen.pixels.size(); ++i) {
    frame.depth[i] = seen.pixels[i].t;
    frame.id[i] = seen.pixels[i].id;
  }
  return frame;
}

// Every kind of camera on every kind of scene.
const std::vector<View>& views() {
  static const std::vector<View> made = [] {
    std::vector<View> result;
    std::uint64_t seed = 0;
    for (const hard::SceneKind& scene : hard::scene_kinds()) {
      for (const hard::CameraKind& kind : hard::camera_kinds()) {
        ++seed;
        hard::Random random(seed);
        const TriangleMesh mesh = scene.make(random);
        const Camera camera = hard::make_camera(kind, seed, mesh);
        result.push_back(
            {std::string(scene.name) + " from " + std::string(kind.name) + ", seed " + std::to_string(seed),
             mesh, camera, oracle_frame(mesh, camera)});
      }
    }
    return result;
  }();
  return made;
}

// What differs in first place, for the message.
std::string difference(const Comparison& comparison) {
  if (comparison.equal()) return "none";
  const PixelDifference& p = comparison.first.front();
  return std::to_string(comparison.different_pixels) + " pixels, first (" + std::to_string(p.x) + ", " +
         std::to_string(p.y) + "): " + std::to_string(p.id_a) + " for " + std::to_string(p.id_b);
}

void check_frame(const Frame& frame, const View& view) {
  const Comparison comparison = compare(frame, view.expected);
  INFO(view.name);
  INFO(difference(comparison));
  CHECK(comparison.equal());
}

// A frame whose every pixel must be overwritten.
Frame dirty_frame(const Camera& camera) {
  Frame frame(camera.width, camera.height);
  for (float& depth : frame.depth) depth = 0.5f;
  for (std::uint32_t& id : frame.id) id = 7;
  return frame;
}

}  // namespace

TEST_SUITE("agree: frames") {
  TEST_CASE("the camera's rays are the oracle's") {
    for (const View& view : views()) {
      CAPTURE(view.name);
      const oracle::Camera camera = witness::to_oracle(view.camera);
      for (int y = -1; y <= view.camera.height; ++y) {
        for (int x = -1; x <= view.camera.width; ++x) {
          const Ray ray = view.camera.ray(x, y);
          const oracle::Ray expected = camera.ray(x, y);
          if (!oracle::can_see(expected)) {
            CHECK_FALSE(oracle::can_see(witness::to_oracle(ray)));
            continue;
          }
          const glm::vec3 direction(expected.direction.x, expected.direction.y, expected.direction.z);
          CHECK(ray.direction == direction);
          CHECK(ray.origin == view.camera.eye);
        }
      }
    }
  }

  TEST_CASE("the views are worth it: hits, misses and pixels that see nothing") {
    std::size_t hits = 0, pixels = 0;
    for (const View& view : views()) {
      pixels += view.expected.id.size();
      for (const std::uint32_t id : view.expected.id) hits += id != kNone ? 1 : 0;
    }
    CHECK(hits > pixels / 5);
    CHECK(hits < pixels * 3 / 4);
  }

  TEST_CASE("frames cast through trees and by brute force are the oracle's, on one to four threads") {
    // More threads than this machine may have processors.
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 4);
    CastOptions options;
    for (const View& view : views()) {
      options.threads = options.threads % 4 + 1;
      Frame frame = dirty_frame(view.camera);
      cast(BruteForce(view.mesh), view.camera, frame, options);
      check_frame(frame, view);
      for (const int width : {2, 4, 8}) {
        CAPTURE(width);
        BuildOptions build;
        build.width = width;
        build.threads = options.threads;
        Frame cast_frame = dirty_frame(view.camera);
        cast(Bvh(view.mesh, build), view.camera, cast_frame, options);
        check_frame(cast_frame, view);
      }
    }
  }
}
