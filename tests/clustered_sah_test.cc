#include "build/clustered_sah.h"

#include <doctest/doctest.h>

#include <array>
#include <bit>
#include <limits>
#include <string>

#include "build/binned_sah.h"
#include "build/tree_check.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "build_util.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "support/fp_modes.h"

using namespace plumb;
using namespace plumb::detail;
using build_scenes::joined;
using build_scenes::same;

namespace {

BinaryTree build(const TriangleMesh& mesh, const ClusteredSahOptions& options = {}) {
  Progress progress(nullptr, mesh.triangles.size());
  return build_clustered_sah(mesh, options, progress);
}

std::string message_of(const ClusteredSahOptions& options) {
  try {
    build(build_scenes::soup(10, 1.0f, 0.1f, 1), options);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_SUITE("clustered SAH") {
  TEST_CASE("every tree over every kind of scene holds its invariants") {
    for (const build_scenes::Scene& scene : build_scenes::all(20000)) {
      CAPTURE(scene.name);
      for (const auto& [max_leaf, block] : {std::array{1, 1}, {4, 1}, {8, 8}, {3, 4}, {255, 4}}) {
        ClusteredSahOptions options;
        options.max_leaf = max_leaf;
        options.block = block;
        CAPTURE(options.max_leaf);
        const BinaryTree tree = build(scene.mesh, options);
        CHECK(joined(check_tree(tree, scene.mesh, max_leaf)) == "");
        CHECK(tree_statistics(tree).depth <= kMaxTreeDepth);
      }
    }
  }

  TEST_CASE("the tree is the same to the bit for every number of threads") {
    for (const build_scenes::Scene& scene : build_scenes::all(100000)) {
      CAPTURE(scene.name);
      ClusteredSahOptions options;
      options.max_leaf = options.block = 8;
      options.threads = 1;
      const BinaryTree alone = build(scene.mesh, options);
      for (options.threads = 2; options.threads <= 4; ++options.threads) {
        CAPTURE(options.threads);
        CHECK(same(build(scene.mesh, options), alone));
      }
    }
  }

  TEST_CASE("the tree does not depend on the caller's floating-point mode") {
    for (const build_scenes::Scene& scene : build_scenes::all(5000)) {
      CAPTURE(scene.name);
      const BinaryTree tree = build(scene.mesh);
      const BinaryTree other = hard::under_mode(hard::kOddestFpMode, [&] { return build(scene.mesh); });
      CHECK(same(other, tree));
    }
  }

  TEST_CASE("no, one and two triangles make the smallest trees") {
    ClusteredSahOptions options;
    options.max_leaf = 1;
    CHECK(build({}, options).nodes.empty());
    for (std::uint32_t count = 1; count <= 2; ++count) {
      for (const TriangleMesh& mesh :
           {build_scenes::soup(count, 1.0f, 0.1f, 20), build_scenes::repeated(count)}) {
        const BinaryTree tree = build(mesh, options);
        CHECK(tree.nodes.size() == 2 * count - 1);
        CHECK(joined(check_tree(tree, mesh, 1)) == "");
      }
    }
    TriangleMesh unseen = build_scenes::soup(2, 1.0f, 0.1f, 21);
    unseen.positions[1].y = unseen.positions[5].z = std::numeric_limits<float>::quiet_NaN();
    CHECK(build(unseen).nodes.empty());
    CHECK(build(unseen).unseen == 2);
  }

  TEST_CASE("copies of one triangle make a balanced tree of full leaves") {
    ClusteredSahOptions options;
    options.block = options.max_leaf = 8;
    const Statistics statistics = tree_statistics(build(build_scenes::repeated(100000), options));
    CHECK(statistics.leaves == 100000 / 8);
    CHECK(statistics.depth == 1 + std::bit_width(100000u / 8 - 1));
  }

  TEST_CASE("trees cost a little more than binned ones") {
    for (const build_scenes::Scene& scene : build_scenes::all(20000)) {
      CAPTURE(scene.name);
      ClusteredSahOptions options;
      options.max_leaf = options.block = 8;
      BinnedSahOptions binned;
      binned.max_leaf = binned.block = 8;
      Progress progress(nullptr, scene.mesh.triangles.size());
      const double cost = tree_statistics(build(scene.mesh, options)).sah_cost;
      const double best = tree_statistics(build_binned_sah(scene.mesh, binned, progress)).sah_cost;
      MESSAGE(scene.name << ": " << cost / best << " of the binned tree's cost");
      // Neighbours' centres say little about where long triangles lie.
      CHECK(cost <= (std::string(scene.name) == "slivers" ? 2.6 : 1.4) * best);
    }
  }

  TEST_CASE("Quality::Fast is this tree, with the same answers") {
    const TriangleMesh mesh = build_scenes::soup(5000, 10.0f, 1.0f, 22);
    const Bvh fast(mesh, {.quality = Quality::Fast}), balanced(mesh);
    CHECK(fast.statistics().sah_cost != balanced.statistics().sah_cost);
    for (int i = 0; i < 500; ++i) {
      const Ray ray{{-20.0f, 0.04f * static_cast<float>(i) - 10.0f, 1.0f}, 0.0f, {1.0f, 0.01f, -0.05f}};
      CHECK(fast.closest(ray) == balanced.closest(ray));
    }
  }

  TEST_CASE("progress reaches the end, and false ends the build") {
    const TriangleMesh mesh = build_scenes::soup(20000, 10.0f, 0.1f, 24);
    double last = 0.0;
    Progress all(
        [&](double share) {
          CHECK(share >= last);
          last = share;
          return true;
        },
        mesh.triangles.size());
    build_clustered_sah(mesh, {}, all);
    CHECK(last > 0.99);
    int calls = 0;
    Progress ends([&](double) { return ++calls < 2; }, mesh.triangles.size());
    CHECK_THROWS_AS(build_clustered_sah(mesh, {}, ends), Cancelled);
    CHECK(calls == 2);
  }

  TEST_CASE("options out of range are errors that name them") {
    ClusteredSahOptions options;
    options.max_leaf = 256;
    CHECK(message_of(options).find("ClusteredSahOptions::max_leaf is 256") != std::string::npos);
    options = {};
    options.block = 3;
    CHECK(message_of(options).find("ClusteredSahOptions::block is 3") != std::string::npos);
  }
}
