#include <doctest/doctest.h>

#include <cstddef>
#include <cstdlib>
#include <string>
#include <vector>

#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/simd.h"
#include "support/effort.h"
#include "support/print.h"
#include "support/shared_data.h"
#include "support/structures_of_cells.h"

// Every hit along the shared hard rays, in order: structures against brute force over the same triangles. One
// ray in so many is taken, or all of them when PLUMB_EVERY_RAY is set in the environment (some minutes).

using namespace plumb;

namespace {

std::size_t ray_stride() { return std::getenv("PLUMB_EVERY_RAY") != nullptr ? 1 : 50 * hard::kEffortDivisor; }

}  // namespace

TEST_SUITE("truth: all hits") {
  TEST_CASE("the lists of all hits equal brute force's on every width and instruction set") {
    PLUMB_REQUIRE_SHARED();
    std::size_t lists = 0, hits = 0;
    for (const std::string& scene : shared::scenes()) {
      CAPTURE(scene);
      const TriangleMesh mesh = shared::load_scene(scene);
      const std::vector<Ray> rays = shared::rays(scene);
      const BruteForce brute(mesh);
      std::vector<std::vector<Hit>> expected(rays.size());
      for (std::size_t i = 0; i < rays.size(); i += ray_stride()) brute.all(rays[i], expected[i]);
      const auto check = [&](const Structure& structure) {
        std::vector<Hit> found;
        for (std::size_t i = 0; i < rays.size(); i += ray_stride()) {
          CAPTURE(i);
          structure.all(rays[i], found);
          CHECK(found == expected[i]);
          ++lists;
          hits += found.size();
        }
      };
      // Under the sanitizers a large scene takes minutes.
      const bool with_cells = mesh.triangles.size() < 100'000 || hard::kEffortDivisor == 1;
      const std::vector<Structure> structures =
          with_cells ? structures_of_cells(mesh) : std::vector<Structure>{};
      for (const Simd simd : simd_targets()) {
        CAPTURE(simd_name(simd));
        for (const Structure& structure : structures) check(structure.with_simd(simd));
        for (const int width : {2, 4, 8}) {
          if (width == 2 && simd != simd_targets().front()) continue;
          CAPTURE(width);
          BuildOptions options;
          options.width = width;
          options.simd = simd;
          check(Bvh(mesh, options));
        }
      }
    }
    CHECK(hits > lists / 2);
    MESSAGE(lists << " lists, " << hits << " hits");
  }
}
