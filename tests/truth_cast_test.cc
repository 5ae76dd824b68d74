#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "plumb/bvh.h"
#include "plumb/camera.h"
#include "plumb/cast.h"
#include "plumb/frame.h"
#include "plumb/simd.h"
#include "support/effort.h"
#include "support/print.h"
#include "support/shared_data.h"
#include "support/structures_of_cells.h"

// The structures against exact answers that were made without the library.

using namespace plumb;

namespace {

// Scenes below this are small enough to go through every instruction set.
constexpr std::size_t kFewTriangles = 40000;

constexpr CastMethod kAnyWay[] = {CastMethod::Auto};
constexpr CastMethod kBothWays[] = {CastMethod::Tiles, CastMethod::Rays};

void check_rays(const Structure& structure, const std::string& scene) {
  const std::vector<Ray> rays = shared::rays(scene);
  const std::vector<Hit> expected = shared::hits(scene);
  REQUIRE(rays.size() == expected.size());
  std::vector<Hit> closest(rays.size());
  const auto any = std::make_unique<bool[]>(rays.size());
  structure.closest(rays, closest);
  structure.any(rays, std::span<bool>(any.get(), rays.size()));
  std::vector<Hit> all;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CAPTURE(i);
    CHECK(closest[i] == expected[i]);
    CHECK(any[i] == (expected[i].id != kNone));
    structure.all(rays[i], all);
    CHECK((all.empty() ? Hit{} : all.front()) == expected[i]);
  }
}

void check_frames(const Structure& structure, const std::string& scene,
                  std::span<const CastMethod> methods = kAnyWay) {
  for (const shared::View& view : shared::views_of(scene)) {
    CAPTURE(view.name);
    const Camera camera = Camera::look_at(view.eye, view.target, view.up, view.fov_y_degrees,
                                          shared::kFrameWidth, shared::kFrameHeight);
    const Frame expected = shared::frame(view);
    for (const CastMethod method : methods) {
      Frame frame(shared::kFrameWidth, shared::kFrameHeight);
      CastOptions options;
      options.method = method;
      cast(structure, camera, frame, options);
      CHECK(compare(frame, expected).different_pixels == 0);
    }
  }
}

void check(const std::string& scene, const TriangleMesh& mesh, int width, Simd simd,
           Quality quality = Quality::Balanced, bool compact = false) {
  CAPTURE(width);
  CAPTURE(simd_name(simd));
  BuildOptions options;
  options.quality = quality;
  options.compact = compact;
  options.width = width;
  options.simd = simd;
  const Bvh bvh(mesh, options);
  check_rays(bvh, scene);
  check_frames(bvh, scene, width == 2 || compact ? kAnyWay : std::span<const CastMethod>(kBothWays));
}

}  // namespace

TEST_SUITE("truth: trees") {
  TEST_CASE("trees of every width answer all hard rays and frames as the shared truth does") {
    PLUMB_REQUIRE_SHARED();
    for (const std::string& scene : shared::scenes()) {
      CAPTURE(scene);
      const TriangleMesh mesh = shared::load_scene(scene);
      for (const int width : {2, 4, 8}) check(scene, mesh, width, Simd::Auto);
      for (const Quality quality : {Quality::Fast, Quality::Best}) check(scene, mesh, 8, Simd::Auto, quality);
    }
  }

  TEST_CASE("on the smaller scenes every instruction set does") {
    PLUMB_REQUIRE_SHARED();
    for (const std::string& scene : shared::scenes()) {
      const TriangleMesh mesh = shared::load_scene(scene);
      if (mesh.triangles.size() >= kFewTriangles) continue;
      CAPTURE(scene);
      for (const Simd simd : simd_targets()) {
        for (const int width : {4, 8}) check(scene, mesh, width, simd);
        check(scene, mesh, 8, simd, Quality::Balanced, true);
      }
    }
  }

  TEST_CASE("structures of cells do, on the smaller scenes with every instruction set") {
    PLUMB_REQUIRE_SHARED();
    for (const std::string& scene : shared::scenes()) {
      CAPTURE(scene);
      const TriangleMesh mesh = shared::load_scene(scene);
      // Under the sanitizers they take minutes.
      if (mesh.triangles.size() >= kFewTriangles && hard::kEffortDivisor > 1) continue;
      for (const Structure& structure : structures_of_cells(mesh)) {
        for (const Simd simd : simd_targets()) {
          const bool one_target = mesh.triangles.size() >= kFewTriangles || hard::kEffortDivisor > 1;
          if (one_target && simd != simd_targets().front()) continue;
          CAPTURE(simd_name(simd));
          check_rays(structure.with_simd(simd), scene);
          check_frames(structure.with_simd(simd), scene);
        }
      }
    }
  }
}
