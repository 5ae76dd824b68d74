#include <doctest/doctest.h>

#include <optional>
#include <string>
#include <vector>

#include "oracle/oracle.h"
#include "support/effort.h"
#include "support/oracle_adapter.h"
#include "support/print.h"
#include "support/shared_data.h"

// The oracle against exact answers that were made without it or the library.

using namespace plumb;

namespace {

// One pixel in so many is checked. The number is coprime with the width, so all columns are met.
constexpr std::size_t kPixelStride = 57 * hard::kEffortDivisor;

}  // namespace

TEST_SUITE("truth: oracle") {
  TEST_CASE("the oracle answers the hard rays as the shared truth does") {
    PLUMB_REQUIRE_SHARED();
    for (const std::string& name : shared::scenes()) {
      CAPTURE(name);
      const oracle::Scene scene(witness::to_oracle(shared::load_scene(name)));
      const std::vector<Ray> rays = shared::rays(name);
      const std::vector<Hit> hits = shared::hits(name);
      REQUIRE(rays.size() == 2000);
      REQUIRE(hits.size() == rays.size());
      for (std::size_t i = 0; i < rays.size(); i += hard::kEffortDivisor) {
        CAPTURE(i);
        CHECK(witness::to_plumb(scene.closest(witness::to_oracle(rays[i]))) == hits[i]);
      }
    }
  }

  TEST_CASE("the oracle sees pixels of every frame as the shared truth does") {
    PLUMB_REQUIRE_SHARED();
    for (const std::string& name : shared::scenes()) {
      const oracle::Scene scene(witness::to_oracle(shared::load_scene(name)));
      for (const shared::View& view : shared::views_of(name)) {
        CAPTURE(name);
        CAPTURE(view.name);
        const std::optional<oracle::Camera> camera = oracle::look_at(
            witness::to_oracle(view.eye), witness::to_oracle(view.target), witness::to_oracle(view.up),
            view.fov_y_degrees, shared::kFrameWidth, shared::kFrameHeight);
        REQUIRE(camera.has_value());
        const Frame frame = shared::frame(view);
        for (std::size_t i = 0; i < frame.id.size(); i += kPixelStride) {
          CAPTURE(i);
          const int x = static_cast<int>(i) % shared::kFrameWidth;
          const int y = static_cast<int>(i) / shared::kFrameWidth;
          CHECK(witness::to_plumb(scene.closest(camera->ray(x, y))) == Hit{frame.depth[i], frame.id[i]});
        }
      }
    }
  }
}
