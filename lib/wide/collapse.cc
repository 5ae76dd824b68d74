#include "wide/collapse.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "build/box.h"
#include "build/chunks.h"

namespace plumb::detail {
namespace {

// A leaf of the binary tree and the first of its blocks.
struct LeafPlace {
  std::uint32_t node;
  std::uint32_t block;
};

// The shape of the wide tree: the children of every node, but not yet the triangles.
template <int W>
class Shape {
 public:
  explicit Shape(const BinaryTree& binary) : binary_(binary) {
    nodes.reserve(binary.nodes.size() / W + 1);
    leaves.reserve(binary.nodes.size() / 2 + 1);
    if (binary.nodes.empty()) {
      nodes.push_back(empty_node());
    } else {
      add_node(0);
    }
  }

  AlignedVector<WideNode<W>> nodes;
  std::vector<LeafPlace> leaves;
  std::uint32_t blocks = 0;

 private:
  struct Child {
    std::uint32_t node;  // of the binary tree
    double area;         // negative for a leaf, which cannot be opened
  };
  struct Children {
    std::array<Child, W> child;
    int count = 0;

    void push(const BinaryTree& binary, std::uint32_t index) {
      const BinaryNode& node = binary.nodes[index];
      child[static_cast<std::size_t>(count++)] = {index, node.count != 0 ? -1.0 : half_area(node.box)};
    }
  };

  // Among equal areas the one that came in first, so that flat scenes are opened level by level.
  Children choose(std::uint32_t root) const {
    Children children;
    children.push(binary_, root);
    while (children.count < W) {
      const auto end = children.child.begin() + children.count;
      const auto widest = std::max_element(children.child.begin(), end,
                                           [](const Child& a, const Child& b) { return a.area < b.area; });
      if (widest->area < 0.0) break;
      const std::uint32_t first = binary_.nodes[widest->node].first;
      std::move(widest + 1, end, widest);
      --children.count;
      children.push(binary_, first);
      children.push(binary_, first + 1);
    }
    return children;
  }

  static void set_box(WideNode<W>& node, int i, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      node.bounds[2 * axis][i] = box.lo[axis];
      node.bounds[2 * axis + 1][i] = box.hi[axis];
    }
  }

  static WideNode<W> empty_node() {
    WideNode<W> node{};
    for (int i = 0; i < W; ++i) {
      set_box(node, i, empty_box());
      node.child[i] = kNoChild;
    }
    return node;
  }

  std::uint32_t add_node(std::uint32_t root) {
    const auto self = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(empty_node());
    const Children children = choose(root);
    // Leaves first: their blocks come near their parent's.
    for (int i = 0; i < children.count; ++i) {
      const std::uint32_t index = children.child[static_cast<std::size_t>(i)].node;
      const BinaryNode& node = binary_.nodes[index];
      set_box(nodes[self], i, node.box);
      if (node.count == 0) continue;
      nodes[self].child[i] = blocks;
      nodes[self].count[i] = node.count;
      leaves.push_back({index, blocks});
      blocks += (node.count + W - 1) / W;
    }
    for (int i = 0; i < children.count; ++i) {
      if (nodes[self].count[i] != 0) continue;
      const std::uint32_t child = add_node(children.child[static_cast<std::size_t>(i)].node);
      nodes[self].child[i] = child;
    }
    return self;
  }

  const BinaryTree& binary_;
};

// TriangleBlock::extent. The sum is exact but for the last bits of a double, far inside the slack that
// covers it and any order of summing in float; a difference that overflows makes it infinite.
float extent_of(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto length = [&](const glm::vec3& to) {
    return (double{std::fabs(to.x - a.x)} + double{std::fabs(to.y - a.y)}) + double{std::fabs(to.z - a.z)};
  };
  const double greatest = std::max(length(b), length(c)) * (1.0 + 4 * 0x1p-24);
  if (greatest > double{std::numeric_limits<float>::max()}) return std::numeric_limits<float>::infinity();
  return std::max(static_cast<float>(greatest), 0x1p-30f);
}

template <int W>
void fill_leaf(const BinaryTree& binary, MeshView mesh, std::uint32_t first_id, const LeafPlace& leaf,
               TriangleBlock<W>* blocks) {
  const BinaryNode& node = binary.nodes[leaf.node];
  for (std::uint32_t i = 0; i < node.count; ++i) {
    TriangleBlock<W>& block = blocks[leaf.block + i / W];
    const std::uint32_t lane = i % W;
    const std::uint32_t index = binary.order[node.first + i];
    const glm::uvec3& corners = mesh.triangles[index];
    const glm::vec3 vertex[3] = {mesh.positions[corners.x], mesh.positions[corners.y],
                                 mesh.positions[corners.z]};
    for (int v = 0; v < 3; ++v) {
      for (int axis = 0; axis < 3; ++axis) block.vertex[v][axis][lane] = vertex[v][axis];
    }
    block.extent[lane] = extent_of(vertex[0], vertex[1], vertex[2]);
    block.id[lane] = first_id + index;
  }
}

}  // namespace

template <int W>
WideTree<W> collapse(const BinaryTree& tree, MeshView mesh, std::uint32_t first_id, int threads) {
  const DefaultFpMode guard;
  Shape<W> shape(tree);
  WideTree<W> wide;
  wide.box = tree.nodes.empty() ? empty_box() : tree.nodes[0].box;
  wide.greatest = greatest_coordinate(wide.box);
  wide.nodes = std::move(shape.nodes);
  wide.blocks.resize(shape.blocks);
  const std::vector<LeafPlace>& leaves = shape.leaves;
  in_arena(threads, [&] {
    for_pieces(leaves.size(), piece_count(leaves.size(), 1024),
               [&](std::size_t, std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i)
                   fill_leaf<W>(tree, mesh, first_id, leaves[i], wide.blocks.data());
               });
  });
  return wide;
}

template WideTree<4> collapse(const BinaryTree&, MeshView, std::uint32_t, int);
template WideTree<8> collapse(const BinaryTree&, MeshView, std::uint32_t, int);

}  // namespace plumb::detail
