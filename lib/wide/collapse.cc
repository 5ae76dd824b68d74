#include "wide/collapse.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "build/box.h"
#include "build/chunks.h"
#include "wide/wide_cuts.h"

namespace plumb::detail {
namespace {

constexpr std::size_t kPieceSize = 512;  // wide nodes
constexpr std::size_t kFetchAhead = 2;
constexpr std::size_t kFewTriangles = 80000;

// The children of a wide node: which nodes of the binary tree they are, and what WideNode::child will be.
template <int W>
struct PlannedNode {
  int count = 0;
  std::array<std::uint32_t, W> binary;
  std::array<std::uint32_t, W> child;
};

// The shape of the wide tree, decided before any memory for it is taken.
template <int W>
class Plan {
 public:
  explicit Plan(const BinaryTree& binary) : binary_(binary) {
    if (binary.nodes.empty()) {
      nodes.emplace_back();
    } else {
      add_node(WideCuts<W>(binary), 0);
    }
  }

  std::vector<PlannedNode<W>> nodes;
  std::uint32_t blocks = 0;

 private:
  std::uint32_t add_node(const WideCuts<W>& cuts, std::uint32_t root) {
    const auto self = static_cast<std::uint32_t>(nodes.size());
    const auto cut = cuts.children(root);
    PlannedNode<W> node;
    node.count = cut.count;
    node.binary = cut.node;
    nodes.emplace_back();
    const auto count = static_cast<std::size_t>(node.count);
    // Leaves first: their blocks come together, near those of their parent's other leaves.
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t triangles = binary_.nodes[node.binary[i]].count;
      if (triangles == 0) continue;
      node.child[i] = blocks;
      blocks += (triangles + W - 1) / W;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (binary_.nodes[node.binary[i]].count == 0) node.child[i] = add_node(cuts, node.binary[i]);
    }
    nodes[self] = node;
    return self;
  }

  const BinaryTree& binary_;
};

// Writes the wide tree's nodes and blocks where the plan has them.
template <int W>
class Filler {
 public:
  Filler(const BinaryTree& binary, MeshView mesh, std::uint32_t first_id, WideTree<W>& wide)
      : binary_(binary), mesh_(mesh), first_id_(first_id), wide_(wide) {}

  // What a node will need of the mesh lies all over it: it is asked for some nodes ahead, first the
  // triangles, which are needed to ask for their vertices. In line, for GCC 12 takes a function that only
  // prefetches for one without an effect.
  [[gnu::always_inline]] void fetch_triangles(const PlannedNode<W>& planned) const {
    for (int i = 0; i < planned.count; ++i) {
      const BinaryNode& from = binary_.nodes[planned.binary[static_cast<std::size_t>(i)]];
      for (std::uint32_t k = 0; k < from.count; ++k)
        __builtin_prefetch(&mesh_.triangles[binary_.order[from.first + k]]);
    }
  }
  [[gnu::always_inline]] void fetch_vertices(const PlannedNode<W>& planned) const {
    for (int i = 0; i < planned.count; ++i) {
      const BinaryNode& from = binary_.nodes[planned.binary[static_cast<std::size_t>(i)]];
      for (std::uint32_t k = 0; k < from.count; ++k) {
        const glm::uvec3& corners = mesh_.triangles[binary_.order[from.first + k]];
        for (int v = 0; v < 3; ++v) __builtin_prefetch(&mesh_.positions[corners[v]]);
      }
    }
  }

  void fill(const PlannedNode<W>& planned, WideNode<W>& node) const {
    for (int i = 0; i < W; ++i) {
      if (i >= planned.count) {
        set_child(node, i, empty_box(), kNoChild, 0);
        continue;
      }
      const std::uint32_t child = planned.child[static_cast<std::size_t>(i)];
      const BinaryNode& from = binary_.nodes[planned.binary[static_cast<std::size_t>(i)]];
      set_child(node, i, from.box, child, from.count);
      // Block by block where it is at hand, then all of it at once.
      for (std::uint32_t first = 0; first < from.count; first += W) {
        TriangleBlock<W> block{};
        const std::uint32_t count = std::min<std::uint32_t>(from.count - first, W);
        for (std::uint32_t lane = 0; lane < count; ++lane)
          set_triangle(block, lane, mesh_, binary_.order[from.first + first + lane], first_id_);
        wide_.blocks[child + first / W] = block;
      }
    }
  }

 private:
  static void set_child(WideNode<W>& node, int i, const Box& box, std::uint32_t child, std::uint32_t count) {
    for (int axis = 0; axis < 3; ++axis) {
      node.bounds[2 * axis][i] = box.lo[axis];
      node.bounds[2 * axis + 1][i] = box.hi[axis];
    }
    node.child[i] = child;
    node.count[i] = count;
  }

  const BinaryTree& binary_;
  MeshView mesh_;
  std::uint32_t first_id_;
  WideTree<W>& wide_;
};

}  // namespace

template <int W>
WideTree<W> collapse(const BinaryTree& tree, MeshView mesh, std::uint32_t first_id, int threads) {
  const DefaultFpMode guard;
  const Plan<W> plan(tree);
  WideTree<W> wide;
  wide.nodes.resize(plan.nodes.size());
  wide.blocks.resize(plan.blocks);
  wide.box = tree.nodes.empty() ? empty_box() : tree.nodes[0].box;
  wide.greatest = greatest_coordinate(wide.box);

  // A mesh that lies in the second cache is at hand.
  const bool fetch = mesh.triangles.size() > kFewTriangles;
  const Filler<W> filler(tree, mesh, first_id, wide);
  in_arena(threads, [&] {
    const std::size_t pieces = piece_count(plan.nodes.size(), kPieceSize);
    for_pieces(plan.nodes.size(), pieces, [&](std::size_t, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (fetch && i + 2 * kFetchAhead < end) filler.fetch_triangles(plan.nodes[i + 2 * kFetchAhead]);
        if (fetch && i + kFetchAhead < end) filler.fetch_vertices(plan.nodes[i + kFetchAhead]);
        filler.fill(plan.nodes[i], wide.nodes[i]);
      }
    });
  });
  return wide;
}

template WideTree<4> collapse(const BinaryTree&, MeshView, std::uint32_t, int);
template WideTree<8> collapse(const BinaryTree&, MeshView, std::uint32_t, int);

}  // namespace plumb::detail
