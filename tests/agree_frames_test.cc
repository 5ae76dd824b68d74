#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>

#include <oneapi/tbb/global_control.h>

#include "oracle/oracle.h"
#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "plumb/frame.h"
#include "plumb/simd.h"
#include "support/hard_views.h"
#include "support/oracle_adapter.h"

// Whole frames of small hard scenes, as hard cameras see them, against the oracle's.

using namespace plumb;

namespace {

// A frame whose every pixel must be overwritten.
Frame dirty_frame(const Camera& camera) {
  Frame frame(camera.width, camera.height);
  for (float& depth : frame.depth) depth = 0.5f;
  for (std::uint32_t& id : frame.id) id = 7;
  return frame;
}

Quality next(Quality quality) {
  return quality == Quality::Best ? Quality::Fast : static_cast<Quality>(static_cast<int>(quality) + 1);
}

}  // namespace

TEST_SUITE("agree: frames") {
  TEST_CASE("the camera's rays are the oracle's") {
    for (const hard::View& view : hard::views()) {
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
    for (const hard::View& view : hard::views()) {
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
    for (const hard::View& view : hard::views()) {
      options.threads = options.threads % 4 + 1;
      Frame frame = dirty_frame(view.camera);
      cast(BruteForce(view.mesh), view.camera, frame, options);
      CAPTURE(view.name);
      CHECK(hard::difference(frame, view.expected) == "");
      for (const int width : {2, 4, 8}) {
        CAPTURE(width);
        BuildOptions build;
        build.width = width;
        build.threads = options.threads;
        options.method = CastMethod::Rays;
        Frame cast_frame = dirty_frame(view.camera);
        cast(Bvh(view.mesh, build), view.camera, cast_frame, options);
        CHECK(hard::difference(cast_frame, view.expected) == "");
      }
    }
  }

  TEST_CASE("frames cast by tiles are the oracle's, on every instruction set and one to four threads") {
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 4);
    CastOptions options;
    options.method = CastMethod::Tiles;
    Quality quality = Quality::Best;
    for (const hard::View& view : hard::views()) {
      CAPTURE(view.name);
      for (const int width : {4, 8}) {
        CAPTURE(width);
        BuildOptions build;
        build.width = width;
        build.threads = 1;
        build.quality = quality;
        quality = next(quality);
        const Bvh bvh(view.mesh, build);
        for (const Simd simd : simd_targets()) {
          CAPTURE(simd_name(simd));
          options.simd = simd;
          options.threads = options.threads % 4 + 1;
          Frame frame = dirty_frame(view.camera);
          cast(bvh, view.camera, frame, options);
          CHECK(hard::difference(frame, view.expected) == "");
        }
      }
    }
  }

  TEST_CASE("tiles are an error where a structure has none, and otherwise the default") {
    const hard::View& view = hard::views().front();
    const CastOptions tiles{.method = CastMethod::Tiles};
    Frame frame = dirty_frame(view.camera);
    const Frame before = frame;
    CHECK_THROWS_AS(cast(BruteForce(view.mesh), view.camera, frame, tiles), Error);
    CHECK_THROWS_AS(cast(Bvh(view.mesh, {.width = 2}), view.camera, frame, tiles), Error);
    CHECK_THROWS_AS(cast(Bvh(view.mesh, {.compact = true}), view.camera, frame, tiles), Error);
    for (const Arithmetic arithmetic : {Arithmetic::Fast, Arithmetic::Watertight})
      CHECK_THROWS_AS(cast(Bvh(view.mesh, {.arithmetic = arithmetic}), view.camera, frame, tiles), Error);
    CHECK(hard::difference(frame, before) == "");
    cast(Bvh(view.mesh), view.camera, frame);
    CHECK(hard::difference(frame, view.expected) == "");
    frame = dirty_frame(view.camera);
    cast(Bvh(view.mesh, {.compact = true}), view.camera, frame);
    CHECK(hard::difference(frame, view.expected) == "");
  }
}
