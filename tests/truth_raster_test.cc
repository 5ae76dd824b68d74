#include <doctest/doctest.h>

#include <cstddef>
#include <string>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "support/hard_views.h"
#include "support/shared_data.h"

// The rasterizer against exact frames that were made without the library.

using namespace plumb;

TEST_SUITE("truth: rasterizer") {
  TEST_CASE("every instruction set draws every frame of the shared truth") {
    PLUMB_REQUIRE_SHARED();
    for (const std::string& scene : shared::scenes()) {
      const TriangleMesh mesh = shared::load_scene(scene);
      for (const shared::View& view : shared::views_of(scene)) {
        const Camera camera = Camera::look_at(view.eye, view.target, view.up, view.fov_y_degrees,
                                              shared::kFrameWidth, shared::kFrameHeight);
        const Frame expected = shared::frame(view);
        for (const Simd simd : simd_targets()) {
          CAPTURE(scene);
          CAPTURE(view.name);
          CAPTURE(simd_name(simd));
          RasterOptions options;
          options.simd = simd;
          Frame frame(shared::kFrameWidth, shared::kFrameHeight);
          rasterize(mesh, camera, frame, options);
          CHECK(hard::difference(frame, expected) == "");
        }
      }
    }
  }
}
