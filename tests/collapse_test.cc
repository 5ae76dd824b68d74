#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "build/binned_sah.h"
#include "build/box.h"
#include "build/sah_rules.h"
#include "build/tree_check.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "build_util.h"
#include "plumb/error.h"
#include "support/fp_modes.h"
#include "wide/collapse.h"
#include "wide/wide_cuts.h"

using namespace plumb;
using namespace plumb::detail;
using build_scenes::joined;

namespace {

BinaryTree build(const TriangleMesh& mesh, int max_leaf, int block) {
  BinnedSahOptions options;
  options.max_leaf = max_leaf;
  options.block = block;
  return build_scenes::build(mesh, options);
}

template <typename Vector>
bool same_bytes(const Vector& a, const Vector& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0);
}

template <int W>
bool same(const WideTree<W>& a, const WideTree<W>& b) {
  return same_bytes(a.nodes, b.nodes) && same_bytes(a.blocks, b.blocks) && a.box.lo == b.box.lo &&
         a.box.hi == b.box.hi && a.greatest == b.greatest;
}

template <int W>
int used_children(const WideNode<W>& node) {
  int used = 0;
  while (used < W && node.child[used] != kNoChild) ++used;
  return used;
}

template <int W>
void check_scene(const build_scenes::Scene& scene, int max_leaf) {
  CAPTURE(scene.name);
  CAPTURE(W);
  CAPTURE(max_leaf);
  constexpr std::uint32_t kFirstId = 1000;
  const BinaryTree binary = build(scene.mesh, max_leaf, W);
  const WideTree<W> wide = collapse<W>(binary, scene.mesh, kFirstId, 1);
  CHECK(joined(check_tree(wide, scene.mesh, kFirstId, max_leaf)) == "");
  CHECK(same(collapse<W>(binary, scene.mesh, kFirstId, 3), wide));

  const Statistics two = tree_statistics(binary);
  const Statistics many = tree_statistics(wide);
  CHECK(many.leaves == two.leaves);
  CHECK(many.depth <= std::max(two.depth, 2));
}

// The least sum of the wide nodes' areas below a binary tree's node, of all ways to choose their children.
class AllWays {
 public:
  AllWays(const BinaryTree& tree, std::size_t width) : tree_(tree), width_(width) {}

  double least(std::uint32_t node) const {
    if (tree_.nodes[node].count != 0) return 0.0;
    double best = std::numeric_limits<double>::infinity();
    for (const std::vector<std::uint32_t>& children : cuts(node, width_)) {
      if (children.size() < 2) continue;
      double sum = half_area(tree_.nodes[node].box);
      for (const std::uint32_t child : children) sum += least(child);
      best = std::min(best, sum);
    }
    return best;
  }

 private:
  // The sets of up to `most` nodes that together make up all below the node.
  std::vector<std::vector<std::uint32_t>> cuts(std::uint32_t node, std::size_t most) const {
    std::vector<std::vector<std::uint32_t>> all = {{node}};
    const BinaryNode& inner = tree_.nodes[node];
    if (inner.count != 0 || most < 2) return all;
    for (const auto& left : cuts(inner.first, most - 1)) {
      for (const auto& right : cuts(inner.first + 1, most - left.size())) {
        all.push_back(left);
        all.back().insert(all.back().end(), right.begin(), right.end());
      }
    }
    return all;
  }

  const BinaryTree& tree_;
  std::size_t width_;
};

template <int W>
double area_of_nodes(const BinaryTree& tree, const WideCuts<W>& cuts, std::uint32_t node) {
  if (tree.nodes[node].count != 0) return 0.0;
  double sum = half_area(tree.nodes[node].box);
  const auto children = cuts.children(node);
  for (int i = 0; i < children.count; ++i)
    sum += area_of_nodes(tree, cuts, children.node[static_cast<std::size_t>(i)]);
  return sum;
}

}  // namespace

TEST_SUITE("collapse") {
  TEST_CASE("every wide tree over every kind of scene holds its invariants, whatever the threads") {
    for (const build_scenes::Scene& scene : build_scenes::all(10000)) {
      for (const int max_leaf : {1, 8, 21}) {
        check_scene<4>(scene, max_leaf);
        check_scene<8>(scene, max_leaf);
      }
    }
  }

  TEST_CASE("an empty scene is one node without children") {
    const WideTree<4> wide = collapse<4>(build({}, 4, 4), {}, 0, 1);
    CHECK(joined(check_tree(wide, {}, 0, 4)) == "");
    CHECK(wide.nodes.size() == 1);
    CHECK(used_children(wide.nodes[0]) == 0);
    CHECK(wide.blocks.empty());
    CHECK(wide.box.lo.x > wide.box.hi.x);
    CHECK(wide.greatest == 0.0f);
  }

  TEST_CASE("a leaf at the root becomes the only child of one node") {
    const TriangleMesh mesh = build_scenes::soup(5, 1.0f, 0.1f, 1);
    const WideTree<4> wide = collapse<4>(build(mesh, 255, 256), mesh, 7, 1);
    REQUIRE(wide.nodes.size() == 1);
    CHECK(used_children(wide.nodes[0]) == 1);
    CHECK(wide.nodes[0].count[0] == 5);
    CHECK(wide.blocks.size() == 2);
    CHECK(joined(check_tree(wide, mesh, 7, 5)) == "");
  }

  TEST_CASE("no other choice of children makes the wide nodes' areas sum to less") {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      CAPTURE(seed);
      const TriangleMesh mesh =
          build_scenes::soup(4 + static_cast<std::uint32_t>(seed) / 4, 1.0f, 0.5f, seed);
      const BinaryTree tree = build(mesh, 1, 1);
      const double four = area_of_nodes(tree, WideCuts<4>(tree), 0);
      CHECK(four == doctest::Approx(AllWays(tree, 4).least(0)).epsilon(1e-5));
      if (mesh.triangles.size() > 10) continue;  // there are very many ways
      const double eight = area_of_nodes(tree, WideCuts<8>(tree), 0);
      CHECK(eight == doctest::Approx(AllWays(tree, 8).least(0)).epsilon(1e-5));
      CHECK(eight <= four);
    }
  }

  TEST_CASE("32 bits tell apart all nodes and blocks of the largest tree") {
    // A binary tree has at most as many leaves as references; blocks are no more than leaves and full ones.
    constexpr std::uint64_t kNodes = 2 * std::uint64_t{kMostTreeTriangles} - 1;
    static_assert(kNodes < kNoChild);
    CHECK_NOTHROW(require_tree_size(kMostTreeTriangles));
    CHECK_THROWS_AS(require_tree_size(kMostTreeTriangles + 1), Error);
  }

  TEST_CASE("where areas say nothing, nodes are full") {
    const TriangleMesh mesh = build_scenes::repeated(64);
    BinaryTree tree = build(mesh, 1, 1);
    for (BinaryNode& node : tree.nodes) node.box = {{1, 2, 3}, {1, 2, 3}};
    CHECK(collapse<8>(tree, mesh, 0, 1).nodes.size() <= 13);
    CHECK(collapse<4>(tree, mesh, 0, 1).nodes.size() <= 32);
  }

  TEST_CASE("extents that overflow are infinite, and none is below 2^-30") {
    constexpr float kMax = std::numeric_limits<float>::max();
    TriangleMesh mesh;
    build_scenes::add(mesh, {-kMax, 0, 0}, {kMax, 0, 0}, {0, 0, 0});         // a difference overflows
    build_scenes::add(mesh, {0, 0, 0}, {kMax, kMax, 0}, {0, 0, 0});          // their sum does
    build_scenes::add(mesh, {-kMax, -kMax, 0}, {kMax, kMax, 0}, {0, 0, 0});  // two differences do
    build_scenes::add(mesh, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    build_scenes::add(mesh, {0, 0, 0}, {0x1p-149f, 0, 0}, {0, 0, 0});
    const WideTree<8> wide = collapse<8>(build(mesh, 255, 256), mesh, 0, 1);
    CHECK(joined(check_tree(wide, mesh, 0, 255)) == "");
    REQUIRE(wide.blocks.size() == 1);
    for (int lane = 0; lane < 3; ++lane)
      CHECK(wide.blocks[0].extent[lane] == std::numeric_limits<float>::infinity());
    for (int lane = 3; lane < 5; ++lane) CHECK(wide.blocks[0].extent[lane] == 0x1p-30f);
  }

  TEST_CASE("the caller's floating-point mode changes nothing") {
    for (const build_scenes::Scene& scene : build_scenes::all(2000)) {
      CAPTURE(scene.name);
      const BinaryTree binary = build(scene.mesh, 8, 8);
      const WideTree<8> wide = collapse<8>(binary, scene.mesh, 0, 2);
      const WideTree<8> other =
          hard::under_mode(hard::kOddestFpMode, [&] { return collapse<8>(binary, scene.mesh, 0, 2); });
      CHECK(same(other, wide));
    }
  }
}
