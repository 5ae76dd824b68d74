#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <oneapi/tbb/global_control.h>

#include "plumb/frame.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "support/hard_views.h"
#include "support/random.h"

// The rasterizer against the oracle's frames of small hard scenes, as hard cameras see them.

using namespace plumb;

namespace {

// Some of a mesh's triangles and the id of the first of them.
struct Part {
  MeshView mesh;
  std::uint32_t first_id;
};

// A mesh in pieces of up to five triangles, in any order.
std::vector<Part> pieces(hard::Random& random, const TriangleMesh& mesh) {
  const std::span<const glm::uvec3> triangles = mesh.triangles;
  std::vector<Part> parts;
  for (std::size_t first = 0; first < triangles.size();) {
    const std::size_t count = std::min<std::size_t>(triangles.size() - first, random.below(6));
    parts.push_back(
        {MeshView(mesh.positions, triangles.subspan(first, count)), static_cast<std::uint32_t>(first)});
    first += count;
  }
  random.shuffle(parts);
  return parts;
}

}  // namespace

TEST_SUITE("agree: rasterizer") {
  TEST_CASE("rasterized frames are the oracle's, on every instruction set and one to four threads") {
    // More threads than this machine may have processors.
    const oneapi::tbb::global_control allow(oneapi::tbb::global_control::max_allowed_parallelism, 4);
    RasterOptions options;
    for (const hard::View& view : hard::views()) {
      for (const Simd simd : simd_targets()) {
        options.simd = simd;
        options.threads = options.threads % 4 + 1;
        CAPTURE(view.name);
        CAPTURE(simd_name(simd));
        CAPTURE(options.threads);
        Frame frame(view.camera.width, view.camera.height);
        rasterize(view.mesh, view.camera, frame, options);
        CHECK(hard::difference(frame, view.expected) == "");
      }
    }
  }

  TEST_CASE("many draws in any order make the frame of one") {
    hard::Random random(1);
    for (const hard::View& view : hard::views()) {
      CAPTURE(view.name);
      Rasterizer rasterizer(view.camera);
      for (const Part& part : pieces(random, view.mesh)) rasterizer.draw(part.mesh, part.first_id);
      Frame frame(view.camera.width, view.camera.height);
      rasterizer.resolve(frame);
      CHECK(hard::difference(frame, view.expected) == "");
    }
  }

  TEST_CASE("frames of parts merge into the frame of the whole") {
    hard::Random random(2);
    for (const hard::View& view : hard::views()) {
      CAPTURE(view.name);
      Frame frame(view.camera.width, view.camera.height);
      for (const Part& part : pieces(random, view.mesh)) {
        RasterOptions options;
        options.first_id = part.first_id;
        rasterize(part.mesh, view.camera, frame, options);
      }
      CHECK(hard::difference(frame, view.expected) == "");
    }
  }

  TEST_CASE("a cleared rasterizer has forgotten what it drew") {
    for (const hard::View& view : hard::views()) {
      CAPTURE(view.name);
      Rasterizer rasterizer(view.camera);
      rasterizer.draw(view.mesh);
      rasterizer.clear();
      Frame frame(view.camera.width, view.camera.height);
      rasterizer.resolve(frame);
      CHECK(hard::difference(frame, Frame(view.camera.width, view.camera.height)) == "");
      rasterizer.draw(view.mesh);
      rasterizer.resolve(frame);
      CHECK(hard::difference(frame, view.expected) == "");
    }
  }
}
