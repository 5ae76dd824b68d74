#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "build/binned_sah.h"
#include "build/tree_check.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "build_util.h"
#include "plumb/error.h"
#include "support/fp_modes.h"

using namespace plumb;
using namespace plumb::detail;
using build_scenes::build;
using build_scenes::joined;
using build_scenes::same;

namespace {

// Triangles handled over all levels: what the time is proportional to.
std::size_t work(const BinaryTree& tree) {
  std::vector<std::size_t> below(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const BinaryNode& node = tree.nodes[i];
    below[i] = node.count != 0 ? node.count : below[node.first] + below[node.first + 1];
  }
  return std::accumulate(below.begin(), below.end(), std::size_t{0});
}

}  // namespace

TEST_SUITE("binned SAH") {
  TEST_CASE("every tree over every kind of scene holds its invariants") {
    for (const build_scenes::Scene& scene : build_scenes::all(3000)) {
      const TriangleMesh& mesh = scene.mesh;
      for (const auto& [max_leaf, block, bins] :
           {std::array{1, 1, 8}, {4, 1, 32}, {8, 8, 16}, {3, 4, 32}, {255, 4, 32}}) {
        CAPTURE(scene.name);
        BinnedSahOptions options;
        options.max_leaf = max_leaf;
        options.block = block;
        CAPTURE(options.max_leaf);
        options.bins = bins;
        CHECK(joined(check_tree(build(mesh, options), mesh, max_leaf)) == "");
      }
    }
  }

  TEST_CASE("the tree is the same to the bit for every number of threads") {
    // Large enough that several threads split one node together.
    for (const build_scenes::Scene& scene : build_scenes::all(100000)) {
      const TriangleMesh& mesh = scene.mesh;
      CAPTURE(scene.name);
      BinnedSahOptions options;
      options.threads = 1;
      const BinaryTree alone = build(mesh, options);
      CHECK(joined(check_tree(alone, mesh, options.max_leaf)) == "");
      for (options.threads = 2; options.threads <= 4; ++options.threads) {
        CAPTURE(options.threads);
        CHECK(same(build(mesh, options), alone));
      }
    }
  }

  TEST_CASE("the tree does not depend on the caller's floating-point mode") {
    for (const build_scenes::Scene& scene : build_scenes::all(20000)) {
      const TriangleMesh& mesh = scene.mesh;
      CAPTURE(scene.name);
      const BinaryTree tree = build(mesh);
      const BinaryTree other = hard::under_mode(hard::kOddestFpMode, [&] { return build(mesh); });
      CHECK(same(other, tree));
    }
  }

  TEST_CASE("no, one and two triangles make the smallest trees") {
    BinnedSahOptions options;
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

  TEST_CASE("a million copies of one triangle make a balanced tree of full leaves") {
    BinnedSahOptions options;
    options.block = options.max_leaf = 8;
    const TriangleMesh mesh = build_scenes::repeated(1000000);
    const BinaryTree tree = build(mesh, options);
    const Statistics statistics = tree_statistics(tree);
    CHECK(statistics.leaves == 1000000 / 8);
    CHECK(statistics.depth == 1 + std::bit_width(1000000u / 8 - 1));
  }

  TEST_CASE("boxes with one centre are halved") {
    BinnedSahOptions options;
    options.max_leaf = 1;
    const BinaryTree tree = build(build_scenes::concentric(5000), options);
    CHECK(tree_statistics(tree).depth == 1 + std::bit_width(5000u - 1));
  }

  TEST_CASE("the work is n log n on every kind of scene, and no path is too deep") {
    for (const std::uint32_t count : {1000u, 10000u, 100000u}) {
      for (const build_scenes::Scene& scene : build_scenes::all(count)) {
        const TriangleMesh& mesh = scene.mesh;
        CAPTURE(scene.name);
        CAPTURE(count);
        const BinaryTree tree = build(mesh);
        const double levels = static_cast<double>(work(tree)) / static_cast<double>(tree.order.size());
        CHECK(tree_statistics(tree).depth <= kMaxTreeDepth);
        // Scenes of many sizes take a level more for every few powers of two, whatever their count.
        CHECK(levels <= 2 * std::log2(static_cast<double>(count)) + 8);
        CHECK(tree.nodes.size() <= 2 * tree.order.size() - 1);
      }
    }
  }

  TEST_CASE("no path exceeds the depth asked for, down to that of a balanced tree") {
    for (const build_scenes::Scene& scene : build_scenes::all(10000)) {
      const TriangleMesh& mesh = scene.mesh;
      for (const int max_leaf : {1, 3, 8}) {
        CAPTURE(scene.name);
        CAPTURE(max_leaf);
        BinnedSahOptions options;
        options.block = 8;
        options.max_leaf = max_leaf;
        const auto triangles = static_cast<unsigned>(build(mesh, options).order.size());
        const auto leaves =
            (triangles + static_cast<unsigned>(max_leaf) - 1) / static_cast<unsigned>(max_leaf);
        const int least = 1 + static_cast<int>(std::bit_width(leaves - 1));
        for (const int extra : {0, 1, 4}) {
          options.max_depth = least + extra;
          const BinaryTree tree = build(mesh, options);
          CHECK(joined(check_tree(tree, mesh, max_leaf)) == "");
          CHECK(tree_statistics(tree).depth <= options.max_depth);
        }
        options.max_depth = 1;  // cannot be kept: all is halved
        CHECK(tree_statistics(build(mesh, options)).depth == least);
      }
    }
  }

  TEST_CASE("zeros in boxes are positive, whatever the order of the triangles that they came from") {
    const auto is_negative_zero = [](float x) { return x == 0.0f && std::signbit(x); };
    std::size_t zeros = 0;
    for (const build_scenes::Scene& scene : build_scenes::all(1000)) {
      for (const BinaryNode& node : build(scene.mesh).nodes) {
        for (int axis = 0; axis < 3; ++axis) {
          CHECK_FALSE(is_negative_zero(node.box.lo[axis]));
          CHECK_FALSE(is_negative_zero(node.box.hi[axis]));
          zeros += node.box.lo[axis] == 0.0f ? 1 : 0;
        }
      }
    }
    CHECK(zeros > 100);
  }

  TEST_CASE("leaves keep the mesh's order") {
    const TriangleMesh mesh = build_scenes::soup(20000, 1.0f, 0.1f, 22);
    const BinaryTree tree = build(mesh);
    for (const BinaryNode& node : tree.nodes) {
      const auto first = tree.order.begin() + node.first;
      if (node.count != 0) CHECK(std::is_sorted(first, first + node.count));
    }
  }

  TEST_CASE("a leaf is made where a split does not pay") {
    // Two triangles in one box: a split tests both again, and a node before.
    TriangleMesh mesh = build_scenes::repeated(2);
    CHECK(build(mesh).nodes.size() == 1);
    // Far apart it pays, if nodes are cheap.
    mesh = build_scenes::soup(1, 1.0f, 0.1f, 23);
    for (const glm::vec3 corner : std::vector(mesh.positions)) mesh.positions.push_back(corner + 100.0f);
    mesh.triangles.emplace_back(3, 4, 5);
    BinnedSahOptions options;
    options.node_cost = 0.5f;
    CHECK(build(mesh, options).nodes.size() == 3);
    options.node_cost = 2.0f;
    CHECK(build(mesh, options).nodes.size() == 1);
    // And it does not where both fit one test.
    options.node_cost = 1.0f;
    options.block = 4;
    CHECK(build(mesh, options).nodes.size() == 1);
  }

  TEST_CASE("progress reaches the end, and false ends the build") {
    const TriangleMesh mesh = build_scenes::soup(200000, 10.0f, 0.1f, 24);
    for (const int threads : {1, 2}) {
      BinnedSahOptions options;
      options.threads = threads;
      double last = 0.0;
      bool rising = true;
      Progress all(
          [&](double share) {
            rising = rising && share >= last;
            last = share;
            return true;
          },
          mesh.triangles.size());
      build_binned_sah(mesh, options, all);
      CHECK(last > 0.99);
      CHECK(rising);

      int calls = 0;
      Progress ends([&](double) { return ++calls < 3; }, mesh.triangles.size());
      CHECK_THROWS_AS(build_binned_sah(mesh, options, ends), Cancelled);
      CHECK(calls == 3);
    }
  }

  TEST_CASE("options out of range are errors that name them") {
    const TriangleMesh mesh = build_scenes::soup(10, 1.0f, 0.1f, 25);
    const auto message = [&](const BinnedSahOptions& options) -> std::string {
      try {
        build(mesh, options);
      } catch (const Error& error) {
        return error.what();
      }
      return "";
    };
    BinnedSahOptions options;
    options.bins = 33;
    CHECK(message(options).find("bins is 33") != std::string::npos);
    options = {};
    options.max_leaf = 0;
    CHECK(message(options).find("max_leaf is 0") != std::string::npos);
    options = {};
    options.block = 3;
    CHECK(message(options).find("block is 3") != std::string::npos);
    options = {};
    options.max_depth = kMaxTreeDepth + 1;
    CHECK(message(options).find("max_depth is 97") != std::string::npos);
    options = {};
    options.node_cost = std::numeric_limits<float>::quiet_NaN();
    CHECK(message(options).find("node_cost") != std::string::npos);
    options = {};
    options.triangle_cost = -1.0f;
    CHECK(message(options).find("triangle_cost") != std::string::npos);
    options = {};
    options.threads = -1;
    CHECK(message(options).find("threads") != std::string::npos);
  }
}
