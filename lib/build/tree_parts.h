#pragma once

#include <memory>
#include <vector>

#include "build/binary_tree.h"

namespace plumb::detail {

/// A subtree that tasks have built apart from the rest: an inner node over two parts, or the nodes that
/// one thread built, in the layout of BinaryTree with nodes[0] as its root.
struct TreePart {
  Box box;  ///< of an inner node
  std::unique_ptr<TreePart> child[2];
  std::vector<BinaryNode> nodes;
};

/// Joins the parts into one array in depth-first order: both children of a node, then all that is below
/// the first, then all that is below the second. When the parts' own nodes come in that order too, the
/// result does not depend on how the tree was cut into parts. Call it in an arena.
std::vector<BinaryNode> join_parts(const TreePart& root);

}  // namespace plumb::detail
