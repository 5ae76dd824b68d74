// Large scenes, where the oracle would take too long: every method, width, target and thread count against
// the binary BVH, bit for bit.

#include <doctest/doctest.h>

#include <string>

#include <oneapi/tbb/global_control.h>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/kd_tree.h"
#include "plumb/octree.h"
#include "plumb/raster.h"
#include "support/effort.h"

using namespace plumb;

namespace {

Frame cast_frame(const BuiltinScene& scene, const Camera& camera, int width, Simd simd, int threads,
                 CastMethod method = CastMethod::Rays) {
  BuildOptions build;
  build.width = width;
  build.simd = simd;
  build.threads = threads;
  CastOptions options;
  options.threads = threads;
  options.method = method;
  Frame frame(camera.width, camera.height);
  cast(Bvh(scene.mesh, build), camera, frame, options);
  return frame;
}

Frame cast_frame(const Structure& structure, const Camera& camera, int threads) {
  Frame frame(camera.width, camera.height);
  cast(structure, camera, frame, {.threads = threads});
  return frame;
}

Frame raster_frame(const BuiltinScene& scene, const Camera& camera, Simd simd, int threads) {
  RasterOptions options;
  options.simd = simd;
  options.threads = threads;
  Frame frame(camera.width, camera.height);
  rasterize(scene.mesh, camera, frame, options);
  return frame;
}

void check_equal(const Frame& expected, const Frame& frame) {
  const Comparison comparison = compare(expected, frame);
  CHECK(comparison.different_ids == 0);
  CHECK(comparison.different_depths == 0);
}

}  // namespace

TEST_SUITE("methods") {
  TEST_CASE("all agree on the built-in scenes") {
    // More threads than this machine may have, so that their order varies.
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 4);
    for (const BuiltinInfo& info : builtin_scenes()) {
      CAPTURE(info.name);
      const BuiltinScene scene = builtin_scene(info.name);
      // Ends in the middle of tiles and blocks. Under the sanitizers a larger frame takes minutes.
      const Camera camera = hard::kEffortDivisor == 1 ? scene.camera(417, 235) : scene.camera(157, 83);
      const Frame expected = cast_frame(scene, camera, 2, Simd::Auto, 1);
      const std::vector<Structure> structures = {KdTree(scene.mesh), Octree(scene.mesh)};
      int threads = 1;
      for (const Simd simd : simd_targets()) {
        CAPTURE(simd_name(simd));
        CAPTURE(threads);
        for (const int width : {4, 8}) {
          check_equal(expected, cast_frame(scene, camera, width, simd, threads));
          check_equal(expected, cast_frame(scene, camera, width, simd, threads, CastMethod::Tiles));
        }
        for (const Structure& structure : structures)
          check_equal(expected, cast_frame(structure.with_simd(simd), camera, threads));
        check_equal(expected, raster_frame(scene, camera, simd, threads));
        threads = threads % 4 + 1;
      }
      for (threads = 1; threads <= 4; ++threads) {
        CAPTURE(threads);
        check_equal(expected, cast_frame(scene, camera, 8, Simd::Auto, threads));
        check_equal(expected, raster_frame(scene, camera, Simd::Auto, threads));
      }
    }
  }
}
