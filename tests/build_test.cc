#include <doctest/doctest.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include "base/fp_mode.h"
#include "build/binned_sah.h"
#include "build/mesh_check.h"
#include "build/tree_check.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "plumb/error.h"

using namespace plumb;
using namespace plumb::detail;

namespace {

BinaryTree build(const TriangleMesh& mesh, const BinnedSahOptions& options = {}) {
  Progress progress(nullptr, mesh.triangles.size());
  return build_binned_sah(mesh, options, progress);
}

bool same(const BinaryTree& a, const BinaryTree& b) {
  return a.unseen == b.unseen && a.order == b.order && a.nodes.size() == b.nodes.size() &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BinaryNode)) == 0;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "; ";
  return text;
}

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
    for (const auto& [name, mesh] : build_scenes::all(3000)) {
      for (const auto& [max_leaf, block, bins] :
           {std::array{1, 1, 8}, {4, 1, 32}, {8, 8, 16}, {3, 4, 32}, {255, 4, 32}}) {
        CAPTURE(name);
        CAPTURE(max_leaf);
        BinnedSahOptions options;
        options.max_leaf = max_leaf;
        options.block = block;
        options.bins = bins;
        CHECK(joined(check_tree(build(mesh, options), mesh, max_leaf)) == "");
      }
    }
  }

  TEST_CASE("the tree is the same to the bit for every number of threads") {
    // Large enough that several threads split one node together.
    for (const auto& [name, mesh] : build_scenes::all(100000)) {
      CAPTURE(name);
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
#if defined(__SSE2__)
    for (const auto& [name, mesh] : build_scenes::all(20000)) {
      CAPTURE(name);
      const BinaryTree tree = build(mesh);
      const FpMode saved = fp_mode();
      set_fp_mode(saved | 0xe040u);  // flush to zero, denormals are zero, round toward zero
      const BinaryTree other = build(mesh);
      set_fp_mode(saved);
      CHECK(same(other, tree));
    }
#endif
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
      for (const auto& [name, mesh] : build_scenes::all(count)) {
        CAPTURE(name);
        CAPTURE(count);
        const BinaryTree tree = build(mesh);
        const double levels = static_cast<double>(work(tree)) / static_cast<double>(tree.order.size());
        CHECK(tree_statistics(tree).depth <= kMaxTreeDepth);
        CHECK(levels <= 2.5 * std::log2(static_cast<double>(count)));
        CHECK(tree.nodes.size() <= 2 * tree.order.size() - 1);
      }
    }
  }

  TEST_CASE("a chain that would peel off one triangle a level ends at the depth bound") {
    // Sizes grow by 64 a triangle, more than the 32 bins resolve. Each is there a thousand times, so that
    // the chain is long and its end still needs many levels.
    TriangleMesh mesh;
    for (int i = -20; i <= 20; ++i) {
      const float size = std::ldexp(1.0f, 6 * i);
      build_scenes::add(mesh, {size, size, size}, {2 * size, size, size}, {size, 2 * size, 2 * size});
    }
    const std::vector<glm::uvec3> once = mesh.triangles;
    for (int i = 1; i < 1000; ++i) mesh.triangles.insert(mesh.triangles.end(), once.begin(), once.end());
    BinnedSahOptions options;
    options.max_leaf = 1;
    const BinaryTree tree = build(mesh, options);
    CHECK(joined(check_tree(tree, mesh, 1)) == "");
    CHECK(tree_statistics(tree).depth > 41);
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
      if (threads == 1) CHECK(rising);

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

TEST_SUITE("mesh check") {
  TEST_CASE("an index out of range is named with its triangle") {
    TriangleMesh mesh = build_scenes::soup(100, 1.0f, 0.1f, 30);
    CHECK_NOTHROW(check_mesh(mesh, 0, "Test"));
    for (int corner = 0; corner < 3; ++corner) {
      for (const std::uint32_t index : {300u, 0xffffffffu}) {
        TriangleMesh wrong = mesh;
        wrong.triangles[57][corner] = index;
        std::string message;
        try {
          check_mesh(wrong, 0, "Test");
        } catch (const Error& error) {
          message = error.what();
        }
        CHECK(message.find("Test") != std::string::npos);
        CHECK(message.find("triangle 57") != std::string::npos);
        CHECK(message.find(std::to_string(index)) != std::string::npos);
        CHECK(message.find("300 positions") != std::string::npos);
      }
    }
    CHECK_NOTHROW(check_mesh(TriangleMesh{}, 0, "Test"));
    CHECK_THROWS_AS(check_mesh(TriangleMesh{{}, {{0, 0, 0}}}, 0, "Test"), Error);
  }

  TEST_CASE("no id may be the one that means none") {
    const TriangleMesh mesh = build_scenes::soup(100, 1.0f, 0.1f, 31);
    CHECK_NOTHROW(check_mesh(mesh, 0xffffffffu - 100, "Test"));
    CHECK_THROWS_AS(check_mesh(mesh, 0xffffffffu - 99, "Test"), Error);
    CHECK_THROWS_AS(check_mesh(mesh, 0xffffffffu, "Test"), Error);
    CHECK_NOTHROW(check_mesh(TriangleMesh{}, 0xffffffffu, "Test"));
  }
}
