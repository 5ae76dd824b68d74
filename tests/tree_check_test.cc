#include "build/tree_check.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "build/binned_sah.h"
#include "build/tree_statistics.h"
#include "build_scenes.h"
#include "build_util.h"
#include "wide/collapse.h"

using namespace plumb;
using namespace plumb::detail;
using build_scenes::joined;

namespace {

constexpr int kMaxLeaf = 6;

// Some triangles are not finite.
TriangleMesh scene() {
  TriangleMesh mesh = build_scenes::soup(500, 10.0f, 1.0f, 1);
  build_scenes::spoil(mesh, 2);
  return mesh;
}

BinaryTree build(const TriangleMesh& mesh) {
  BinnedSahOptions options;
  options.max_leaf = kMaxLeaf;
  options.block = 4;
  options.node_cost = 2.0f;  // so that some leaves take two blocks
  return build_scenes::build(mesh, options);
}

std::uint32_t first_not_finite(const TriangleMesh& mesh) {
  for (std::uint32_t i = 0;; ++i) {
    for (int v = 0; v < 3; ++v) {
      const glm::vec3& p = mesh.positions[mesh.triangles[i][v]];
      if (!std::isfinite(p.x + p.y + p.z)) return i;
    }
  }
}

template <typename Tree>
struct Fault {
  const char* reported;  // part of what the check must say
  std::function<void(Tree&)> make;
};

// The node and the child number of a leaf with a lane to spare, or with more than one block.
std::pair<WideNode<4>*, int> find_leaf(WideTree<4>& tree, const std::function<bool(std::uint32_t)>& wanted) {
  for (WideNode<4>& node : tree.nodes) {
    for (int i = 0; i < 4; ++i) {
      if (node.count[i] != 0 && wanted(node.count[i])) return {&node, i};
    }
  }
  REQUIRE(false);
  return {};
}

}  // namespace

TEST_SUITE("tree check") {
  TEST_CASE("each fault of a binary tree is reported") {
    const TriangleMesh mesh = scene();
    const BinaryTree sound = build(mesh);
    REQUIRE(joined(check_tree(sound, mesh, kMaxLeaf)) == "");
    const std::size_t leaf =
        static_cast<std::size_t>(std::find_if(sound.nodes.begin(), sound.nodes.end(),
                                              [](const BinaryNode& n) { return n.count > 1; }) -
                                 sound.nodes.begin());
    const std::uint32_t not_finite = first_not_finite(mesh);

    const std::vector<Fault<BinaryTree>> faults = {
        {"is in more than one leaf", [](BinaryTree& t) { t.order[0] = t.order[1]; }},
        {"is in no leaf", [](BinaryTree& t) { t.order[0] = t.order[1]; }},
        {"has triangle 500 of 500", [](BinaryTree& t) { t.order[7] = 500; }},
        {"which is not finite", [&](BinaryTree& t) { t.order[7] = not_finite; }},
        {"but unseen is", [](BinaryTree& t) { ++t.unseen; }},
        {"the order has", [](BinaryTree& t) { t.order.push_back(0); }},
        {"ends beyond the order", [](BinaryTree& t) { t.order.pop_back(); }},
        {"ends beyond the order", [&](BinaryTree& t) { t.nodes[leaf].first = 0xffffffffu; }},
        {"more than 6", [&](BinaryTree& t) { t.nodes[leaf].count = 7; }},
        {"is in no leaf", [&](BinaryTree& t) { --t.nodes[leaf].count; }},
        {"node 0 has not the box",
         [](BinaryTree& t) { t.nodes[0].box.hi.x = std::nextafter(t.nodes[0].box.hi.x, 1e30f); }},
        {"has not the box", [&](BinaryTree& t) { t.nodes[leaf].box.lo.z += 0.01f; }},
        {"has not the box",
         [&](BinaryTree& t) { t.nodes[leaf].box.lo.z = std::numeric_limits<float>::quiet_NaN(); }},
        {"does not come after it", [](BinaryTree& t) { t.nodes[1].first = 0, t.nodes[1].count = 0; }},
        {"does not come after it", [](BinaryTree& t) { t.nodes[0].first = 0xffffffffu; }},
        {"does not come after it",
         [](BinaryTree& t) { t.nodes[0].first = static_cast<std::uint32_t>(t.nodes.size() - 1); }},
        {"is a child twice", [](BinaryTree& t) { ++t.nodes[0].first; }},
        {"is no node's child",
         [](BinaryTree& t) {
           t.nodes.push_back({t.nodes[0].box, 0, 0});
         }},
    };
    for (std::size_t i = 0; i < faults.size(); ++i) {
      CAPTURE(i);
      BinaryTree broken = sound;
      faults[i].make(broken);
      CHECK(joined(check_tree(broken, mesh, kMaxLeaf)).find(faults[i].reported) != std::string::npos);
    }
  }

  TEST_CASE("a path that is too long is reported") {
    // A comb: every inner node has a leaf and the next inner node.
    TriangleMesh mesh = build_scenes::repeated(kMaxTreeDepth + 1);
    const Box box = build(mesh).nodes[0].box;
    const auto comb = [&](std::uint32_t leaves) {
      BinaryTree tree;
      tree.nodes = {{box, 0, 1}};
      tree.order = {0};
      for (std::uint32_t i = 1; i < leaves; ++i) {
        const auto first = static_cast<std::uint32_t>(tree.nodes.size());
        tree.nodes[first == 1 ? 0 : first - 1] = {box, first, 0};
        tree.nodes.push_back({box, i - 1, 1});
        tree.nodes.push_back({box, i, 1});
        tree.order.push_back(i);
      }
      mesh.triangles.resize(leaves);
      return joined(check_tree(tree, mesh, 1));
    };
    CHECK(comb(kMaxTreeDepth + 1).find("too deep") != std::string::npos);
    CHECK(comb(kMaxTreeDepth) == "");
  }

  TEST_CASE("each fault of a wide tree is reported") {
    const TriangleMesh mesh = scene();
    constexpr std::uint32_t kFirstId = 77;
    WideTree<4> sound = collapse<4>(build(mesh), mesh, kFirstId, 1);
    REQUIRE(joined(check_tree(sound, mesh, kFirstId, kMaxLeaf)) == "");
    const auto spare = [](WideTree<4>& t) {
      return find_leaf(t, [](std::uint32_t n) { return n % 4 != 0; });
    };
    const auto long_leaf = [](WideTree<4>& t) { return find_leaf(t, [](std::uint32_t n) { return n > 4; }); };
    const auto block_of = [&](WideTree<4>& t) -> TriangleBlock<4>& {
      const auto [node, i] = spare(t);
      return t.blocks[node->child[i] + node->count[i] / 4];
    };
    const std::uint32_t not_finite = first_not_finite(mesh);

    const std::vector<Fault<WideTree<4>>> faults = {
        {"is in more than one leaf", [](WideTree<4>& t) { t.blocks[0].id[0] = t.blocks[1].id[0]; }},
        {"differs from the mesh", [](WideTree<4>& t) { t.blocks[0].id[0] = t.blocks[1].id[0]; }},
        {"differs from the mesh in vertex 2 axis 1",
         [](WideTree<4>& t) { t.blocks[0].vertex[2][1][0] += 1.0f; }},
        {"which is not finite", [&](WideTree<4>& t) { t.blocks[0].id[0] = kFirstId + not_finite; }},
        {"of 500", [](WideTree<4>& t) { t.blocks[0].id[0] = kFirstId - 1; }},
        {"has the extent", [](WideTree<4>& t) { t.blocks[0].extent[0] *= 0.99999f; }},
        {"has the extent", [](WideTree<4>& t) { t.blocks[0].extent[0] *= 1.00001f; }},
        {"has the extent",
         [](WideTree<4>& t) { t.blocks[0].extent[0] = std::numeric_limits<float>::quiet_NaN(); }},
        {"lies past the count and is not zero", [&](WideTree<4>& t) { block_of(t).vertex[0][0][3] = -0.0f; }},
        {"lies past the count and is not zero", [&](WideTree<4>& t) { block_of(t).id[3] = 1; }},
        {"lies past the count and is not zero", [&](WideTree<4>& t) { block_of(t).extent[3] = 1.0f; }},
        {"is in no leaf",
         [&](WideTree<4>& t) {
           const auto [node, i] = long_leaf(t);
           --node->count[i];
         }},
        {"belongs to no leaf",
         [&](WideTree<4>& t) {
           const auto [node, i] = long_leaf(t);
           node->count[i] = 4;
         }},
        {"shares block",
         [&](WideTree<4>& t) {
           const auto [node, i] = long_leaf(t);
           --node->child[i];
         }},
        {"more than 6",
         [&](WideTree<4>& t) {
           const auto [node, i] = long_leaf(t);
           node->count[i] = 7;
         }},
        {"blocks",
         [&](WideTree<4>& t) {
           const auto [node, i] = long_leaf(t);
           node->child[i] = static_cast<std::uint32_t>(t.blocks.size()) - 1;
         }},
        {"has not the box", [](WideTree<4>& t) { t.nodes[0].bounds[3][1] += 0.01f; }},
        {"child 2 has not the box", [](WideTree<4>& t) { t.nodes[0].bounds[4][2] -= 0.01f; }},
        {"does not come after it", [](WideTree<4>& t) { t.nodes[1].child[0] = 0, t.nodes[1].count[0] = 0; }},
        {"does not come after it",
         [](WideTree<4>& t) { t.nodes[1].child[0] = 1u << 30, t.nodes[1].count[0] = 0; }},
        {"is no node's child", [](WideTree<4>& t) { t.nodes.push_back(t.nodes[0]); }},
        {"is a child twice", [](WideTree<4>& t) { t.nodes[0].child[1] = t.nodes[0].child[0]; }},
        {"an empty child comes before", [](WideTree<4>& t) { t.nodes[0].child[0] = kNoChild; }},
        {"has a count",
         [&](WideTree<4>& t) {
           const auto [node, i] = spare(t);
           node->child[i] = kNoChild;
         }},
        {"the tree's box", [](WideTree<4>& t) { t.box.lo.y += 0.01f; }},
        {"greatest is", [](WideTree<4>& t) { t.greatest = 0.5f; }},
        {"there is no node", [](WideTree<4>& t) { t.nodes.clear(); }},
    };
    for (std::size_t i = 0; i < faults.size(); ++i) {
      CAPTURE(i);
      WideTree<4> broken = sound;
      faults[i].make(broken);
      const std::string report = joined(check_tree(broken, mesh, kFirstId, kMaxLeaf));
      CAPTURE(report);
      CHECK(report.find(faults[i].reported) != std::string::npos);
    }
  }
}

TEST_SUITE("tree statistics") {
  TEST_CASE("those of a small tree are as counted by hand") {
    // Two leaves of areas 6 and 24 (half: 3 and 12) in a cube of area 96 (half: 48).
    BinaryTree tree;
    tree.nodes = {
        {{{0, 0, 0}, {4, 4, 4}}, 1, 0}, {{{0, 0, 0}, {1, 1, 1}}, 0, 3}, {{{2, 2, 2}, {4, 4, 4}}, 3, 2}};
    tree.order = {0, 1, 2, 3, 4};
    Statistics s = tree_statistics(tree);
    CHECK(s.nodes == 1);
    CHECK(s.leaves == 2);
    CHECK(s.width == 2);
    CHECK(s.depth == 2);
    CHECK(s.fill == 1.0);
    CHECK(s.leaf_fill == 1.0);
    CHECK(s.sah_cost == 2.0 + 3 * 3.0 / 48 + 2 * 12.0 / 48);
    CHECK(s.bytes >= 3 * 32 + 5 * 4);

    const TriangleMesh mesh = build_scenes::repeated(5);
    s = tree_statistics(collapse<4>(tree, mesh, 0, 1));
    CHECK(s.nodes == 1);
    CHECK(s.leaves == 2);
    CHECK(s.width == 4);
    CHECK(s.depth == 2);
    CHECK(s.fill == 0.5);
    CHECK(s.leaf_fill == 5.0 / 8);
    CHECK(s.sah_cost == 2.0 + 3 * 3.0 / 48 + 2 * 12.0 / 48);
    CHECK(s.bytes >= sizeof(WideNode<4>) + 2 * sizeof(TriangleBlock<4>));
  }

  TEST_CASE("trees over no triangle and over no area have finite ones") {
    Statistics s = tree_statistics(build({}));
    CHECK(s.nodes == 0);
    CHECK(s.leaves == 0);
    CHECK(s.depth == 0);
    CHECK(s.sah_cost == 0.0);
    s = tree_statistics(collapse<8>(build({}), {}, 0, 1));
    CHECK(s.nodes == 1);
    CHECK(s.leaves == 0);
    CHECK(s.sah_cost == 0.0);
    // Every box of a point is met where the root's is.
    TriangleMesh mesh = build_scenes::repeated(10);
    for (glm::vec3& position : mesh.positions) position = {1, 2, 3};
    const BinaryTree tree = build(mesh);
    s = tree_statistics(tree);
    CHECK(s.sah_cost == 2.0 * static_cast<double>(s.nodes) + 10.0);
  }

  TEST_CASE("boxes larger than a float's range have finite areas") {
    for (const build_scenes::Scene& scene : build_scenes::all(1000)) {
      const TriangleMesh& mesh = scene.mesh;
      CAPTURE(scene.name);
      const double cost = tree_statistics(build(mesh)).sah_cost;
      CHECK(cost > 1.0);
      CHECK(cost <= 3.0 * static_cast<double>(mesh.triangles.size()));
    }
  }
}
