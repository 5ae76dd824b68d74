#include "wide/refit.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/common.hpp>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "build/box.h"
#include "build/chunks.h"

namespace plumb::detail {
namespace {

constexpr std::size_t kPieceSize = 512;  // nodes
constexpr std::size_t kFetchAhead = 2;

void grow(Box& box, const Box& by) {
  box.lo = glm::min(box.lo, by.lo);
  box.hi = glm::max(box.hi, by.hi);
}

template <int W>
Box child_box(const WideNode<W>& node, int i) {
  return {{node.bounds[0][i], node.bounds[2][i], node.bounds[4][i]},
          {node.bounds[1][i], node.bounds[3][i], node.bounds[5][i]}};
}

template <int W>
void set_child_box(WideNode<W>& node, int i, const Box& box) {
  for (int axis = 0; axis < 3; ++axis) {
    node.bounds[2 * axis][i] = box.lo[axis];
    node.bounds[2 * axis + 1][i] = box.hi[axis];
  }
}

template <int W>
Box node_box(const WideNode<W>& node) {
  Box box = empty_box();
  for (int i = 0; i < W; ++i) grow(box, child_box(node, i));
  return box;
}

// Empty for a triangle that is not finite.
Box triangle_box(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  for (const glm::vec3& p : {a, b, c}) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return empty_box();
  }
  return {glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)};
}

template <int W>
Box lane_box(const TriangleBlock<W>& block, std::size_t lane) {
  const auto corner = [&](int v) {
    return glm::vec3(block.vertex[v][0][lane], block.vertex[v][1][lane], block.vertex[v][2][lane]);
  };
  return triangle_box(corner(0), corner(1), corner(2));
}

template <int W>
Box set_lane(TriangleBlock<W>& block, std::size_t lane, MeshView mesh, std::uint32_t first_id) {
  const std::uint32_t id = block.id[lane];
  const glm::uvec3& corners = mesh.triangles[id - first_id];
  const Box box =
      triangle_box(mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]);
  if (box.lo.x <= box.hi.x) {
    set_triangle(block, lane, mesh, id - first_id, first_id);
  } else {
    // A point, whose plane no ray crosses.
    for (int k = 0; k < 9; ++k) block.vertex[k / 3][k % 3][lane] = 0.0f;
    block.extent[lane] = 0x1p-30f;
  }
  return box;
}

// Calls lane_box(block, lane) for every triangle of a node's leaves and sums up; set_box(child, box) with
// what the boxes of a leaf join to.
template <int W, class LaneBox, class SetBox>
TreeAreas over_leaves(const WideNode<W>& node, const LaneBox& lane_box, const SetBox& set_box) {
  TreeAreas areas;
  for (int i = 0; i < W; ++i) {
    if (node.count[i] == 0) continue;
    Box box = empty_box();
    for (std::uint32_t k = 0; k < node.count[i]; ++k) {
      const Box triangle = lane_box(node.child[i] + k / W, k % W);
      if (!(triangle.lo.x <= triangle.hi.x)) ++areas.unseen;
      areas.triangles += half_area(triangle);
      grow(box, triangle);
    }
    set_box(i, box);
  }
  return areas;
}

// Of a node whose boxes are right.
template <int W>
double tests_of(const WideNode<W>& node) {
  double sum = 0.0;
  int children = 0;
  for (; children < W && node.child[children] != kNoChild; ++children)
    sum += half_area(child_box(node, children)) * node.count[children];
  return sum + half_area(node_box(node)) * children;
}

// Calls use(mesh triangle) for each triangle of a node's leaves.
template <int W, class Use>
[[gnu::always_inline]] inline void for_triangles(const WideTree<W>& tree, std::size_t node, MeshView mesh,
                                                 std::uint32_t first_id, const Use& use) {
  const WideNode<W>& of = tree.nodes[node];
  for (int i = 0; i < W; ++i) {
    for (std::uint32_t k = 0; k < of.count[i]; ++k)
      use(mesh.triangles[tree.blocks[of.child[i] + k / W].id[k % W] - first_id]);
  }
}

template <int W>
TreeAreas sum_up(const WideTree<W>& tree, const std::vector<TreeAreas>& of_leaves) {
  TreeAreas sum;
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    sum.tests += tests_of(tree.nodes[i]);
    sum.triangles += of_leaves[i].triangles;
    sum.unseen += of_leaves[i].unseen;
  }
  return sum;
}

}  // namespace

template <int W>
TreeAreas tree_areas(const WideTree<W>& tree) {
  std::vector<TreeAreas> of_leaves;
  of_leaves.reserve(tree.nodes.size());
  for (const WideNode<W>& node : tree.nodes) {
    of_leaves.push_back(over_leaves(
        node, [&](std::uint32_t block, std::size_t lane) { return lane_box(tree.blocks[block], lane); },
        [](int, const Box&) {}));
  }
  return sum_up(tree, of_leaves);
}

template <int W>
TreeAreas refit(WideTree<W>& tree, MeshView mesh, std::uint32_t first_id, int threads) {
  const DefaultFpMode guard;
  std::vector<TreeAreas> of_leaves(tree.nodes.size());
  in_arena(threads, [&] {
    const std::size_t pieces = piece_count(tree.nodes.size(), kPieceSize);
    for_pieces(tree.nodes.size(), pieces, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        // The mesh's triangles lie all over it: they are asked for ahead, first their indices.
        if (i + 2 * kFetchAhead < end) {
          for_triangles(tree, i + 2 * kFetchAhead, mesh, first_id,
                        [](const glm::uvec3& corners) { __builtin_prefetch(&corners); });
        }
        if (i + kFetchAhead < end) {
          for_triangles(tree, i + kFetchAhead, mesh, first_id, [&](const glm::uvec3& corners) {
            for (int v = 0; v < 3; ++v) __builtin_prefetch(&mesh.positions[corners[v]]);
          });
        }
        WideNode<W>& node = tree.nodes[i];
        of_leaves[i] = over_leaves(
            node,
            [&](std::uint32_t block, std::size_t lane) {
              return set_lane(tree.blocks[block], lane, mesh, first_id);
            },
            [&](int child, const Box& box) { set_child_box(node, child, box); });
      }
    });
  });
  // Children come after their parents.
  for (std::size_t n = tree.nodes.size(); n-- > 0;) {
    WideNode<W>& node = tree.nodes[n];
    for (int i = 0; i < W; ++i) {
      if (node.count[i] == 0 && node.child[i] != kNoChild)
        set_child_box(node, i, node_box(tree.nodes[node.child[i]]));
    }
  }
  tree.box = node_box(tree.nodes[0]);
  tree.greatest = greatest_coordinate(tree.box);
  return sum_up(tree, of_leaves);
}

template TreeAreas tree_areas(const WideTree<4>&);
template TreeAreas tree_areas(const WideTree<8>&);
template TreeAreas refit(WideTree<4>&, MeshView, std::uint32_t, int);
template TreeAreas refit(WideTree<8>&, MeshView, std::uint32_t, int);

}  // namespace plumb::detail
