#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb::detail {

/// The most nodes on a path from the root to a leaf, both counted. Builders keep to it, whatever the
/// mesh, so that traversals can hold their stacks in fixed arrays.
inline constexpr int kMaxTreeDepth = 96;

struct Box {
  glm::vec3 lo, hi;
};

/// A node of a binary tree over triangles. Inner: `count` is 0 and the children are nodes `first` and
/// `first + 1`. Leaf: the triangles order[first] ... order[first + count - 1].
struct BinaryNode {
  Box box;
  std::uint32_t first;
  std::uint32_t count;
};
static_assert(sizeof(BinaryNode) == 32);

/// nodes[0] is the root. A tree over no triangle has no node. Boxes are exact: the smallest that hold
/// the triangles below. Children come after their parent; the layout depends on the mesh alone.
struct BinaryTree {
  std::vector<BinaryNode> nodes;
  std::vector<std::uint32_t> order;  ///< indices into the mesh's triangles, each finite one once
  std::uint32_t unseen = 0;          ///< triangles left out: a coordinate is NaN or infinite
};

}  // namespace plumb::detail
