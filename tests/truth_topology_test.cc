#include <doctest/doctest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "plumb/bvh.h"
#include "plumb/topology.h"
#include "support/effort.h"
#include "support/random.h"
#include "support/shared_data.h"

// The shared scenes: what other programs counted in them, and rays through the closed ones.

using namespace plumb;
using hard::Random;

TEST_SUITE("truth: topology") {
  TEST_CASE("of the shared scenes is what their table says") {
    PLUMB_REQUIRE_SHARED();
    std::size_t scenes = 0;
    for (const shared::SceneFacts& facts : shared::scene_facts()) {
      if (facts.name == "near_ties") continue;  // its row is words
      CAPTURE(facts.name);
      ++scenes;
      const TriangleMesh mesh = shared::load_scene(facts.name);
      const Topology t = topology(mesh);
      CHECK(mesh.triangles.size() == facts.triangles.value());
      CHECK(mesh.positions.size() == facts.vertices.value());
      CHECK(t.non_finite == 0);
      CHECK(t.unused_vertices == 0);
      CHECK(t.collapsed == facts.collapsed.value());
      CHECK(t.degenerate == facts.degenerate.value());
      CHECK(t.duplicates == facts.duplicates.value());
      CHECK(t.boundary_edges == facts.open_edges.value());
      CHECK(t.non_manifold_edges == facts.edges_of_many.value());
    }
    CHECK(scenes == 15);
  }

  TEST_CASE("those that are closed are left as often as entered, through their vertices") {
    PLUMB_REQUIRE_SHARED();
    Random random(5);
    std::size_t meshes = 0, crossings = 0;
    for (const std::string& scene : shared::scenes()) {
      const TriangleMesh mesh = shared::load_scene(scene);
      if (!topology(mesh).closed()) continue;
      CAPTURE(scene);
      ++meshes;
      for (const int width : {2, 4, 8}) {
        CAPTURE(width);
        BuildOptions options;
        options.width = width;
        const Bvh bvh(mesh, options);
        std::vector<Hit> hits;
        for (int i = 0; i < hard::effort(3000); ++i) {
          // Far outside of every one of them.
          const glm::vec3 origin = (random.unit3() + glm::vec3(3.0f, -4.0f, 5.0f)) * 100.0f;
          bvh.all({origin, 0.0f, random.pick(mesh.positions) - origin}, hits);
          CHECK(hits.size() % 2 == 0);
          crossings += hits.size();
        }
      }
    }
    CHECK(meshes == 2);
    CHECK(crossings > 10'000u / hard::kEffortDivisor);
  }
}
