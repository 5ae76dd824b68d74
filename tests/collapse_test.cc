#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "build/binned_sah.h"
#include "build/tree_check.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "build_util.h"
#include "support/fp_modes.h"
#include "wide/collapse.h"

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
  for (const WideNode<W>& node : wide.nodes) {
    int inner = 0;
    for (int i = 0; i < used_children(node); ++i) inner += node.count[i] == 0 ? 1 : 0;
    CHECK((inner == 0 || used_children(node) == W));  // else one could have been opened
  }
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

  TEST_CASE("the child with the largest area is opened first") {
    // Five leaves below the root: ((a b) (c (d e))). Four children hold three openings: the root's, the
    // larger of its two inner children's, and then, of (d e) and the smaller one, the larger.
    const auto wide_counts = [](float left, float right, float right_inner) {
      TriangleMesh mesh = build_scenes::repeated(5 * 2);
      BinaryTree tree;
      const auto box = [](float size) { return Box{{0, 0, 0}, {size, size, size}}; };
      tree.nodes = {{box(100), 1, 0},         {box(left), 3, 0}, {box(right), 5, 0},
                    {box(1), 0, 1},           {box(1), 1, 1},    {box(1), 2, 1},
                    {box(right_inner), 7, 0}, {box(1), 3, 1},    {box(1), 4, 1}};
      tree.order = {0, 1, 2, 3, 4};
      const WideTree<4> wide = collapse<4>(tree, mesh, 0, 1);
      REQUIRE(used_children(wide.nodes[0]) == 4);
      float closed = 0.0f;  // the size of the child that stayed a node
      int inner = 0;
      for (int i = 0; i < 4; ++i) {
        if (wide.nodes[0].count[i] != 0) continue;
        closed = wide.nodes[0].bounds[1][i];
        ++inner;
      }
      CHECK(inner == 1);
      CHECK(wide.nodes.size() == 2);
      return closed;
    };
    CHECK(wide_counts(10, 20, 15) == 10);
    CHECK(wide_counts(10, 20, 5) == 5);
    CHECK(wide_counts(20, 10, 5) == 5);
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
