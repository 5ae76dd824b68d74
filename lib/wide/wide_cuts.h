#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "build/binary_tree.h"

namespace plumb::detail {

/// Which nodes of a binary tree become the children of each W-wide node, so that the wide nodes' areas sum to
/// the least: a ray's expected tests of nodes. Leaves stay what they are. By dynamic programming (Ylitie,
/// Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs",
/// section 3.1), in time linear in the nodes.
template <int W>
class WideCuts {
 public:
  struct Children {
    int count = 0;
    std::array<std::uint32_t, W> node;
  };

  /// The tree's nodes must come after their parents.
  explicit WideCuts(const BinaryTree& tree);

  /// Of the wide node that the binary tree's inner node becomes, or of a tree that is one leaf, that leaf.
  Children children(std::uint32_t node) const;

 private:
  // The least cost of what is below a node that hangs on a wide one as at most k children, at k - 1.
  using Costs = std::array<float, W - 1>;

  void gather(std::uint32_t node, int most, Children& children) const;
  void open(const BinaryNode& node, int most, Children& children) const;

  const BinaryTree& tree_;
  std::vector<Costs> costs_;
};

extern template class WideCuts<4>;
extern template class WideCuts<8>;

}  // namespace plumb::detail
