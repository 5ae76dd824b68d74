#include <doctest/doctest.h>

#include <string>
#include <vector>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/raster.h"
#include "plumb/stream.h"
#include "support/hard_views.h"
#include "support/shared_data.h"

// Files that are streamed against exact frames that were made without the library.

using namespace plumb;

TEST_SUITE("truth: streams") {
  TEST_CASE("every frame of the shared truth comes of its file in parts") {
    PLUMB_REQUIRE_SHARED();
    StreamOptions options;
    options.memory_bytes = std::size_t{1} << 21;
    for (const std::string& scene : shared::scenes()) {
      const std::vector<shared::View> views = shared::views_of(scene);
      std::vector<Rasterizer> rasterizers;
      for (const shared::View& view : views) {
        rasterizers.emplace_back(Camera::look_at(view.eye, view.target, view.up, view.fov_y_degrees,
                                                 shared::kFrameWidth, shared::kFrameHeight));
      }
      stream_mesh(
          shared::scene_file(scene),
          [&](MeshView part, std::uint32_t first_id) {
            for (Rasterizer& rasterizer : rasterizers) rasterizer.draw(part, first_id);
          },
          options);
      for (std::size_t i = 0; i < views.size(); ++i) {
        CAPTURE(scene);
        CAPTURE(views[i].name);
        Frame frame(shared::kFrameWidth, shared::kFrameHeight);
        rasterizers[i].resolve(frame);
        CHECK(hard::difference(frame, shared::frame(views[i])) == "");
      }
    }
  }
}
