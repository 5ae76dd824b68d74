#pragma once

#include <cstdint>

#include "build/binary_tree.h"
#include "plumb/mesh.h"
#include "wide/wide_tree.h"

namespace plumb::detail {

/// Makes a W-wide tree of a binary one over the same mesh (Wald, Benthin and Boulos 2008, "Getting Rid of
/// Packets", section 3; Ernst and Greiner 2008, "Multi Bounding Volume Hierarchies"): each wide node takes in
/// the binary nodes that wide_cuts.h says. A path has at most as many nodes as in the binary tree.
///
/// Nodes and blocks are stored depth-first. Ids are `first_id` plus the triangle's index. The result
/// depends on the tree and the mesh alone. Defined for W = 4 and 8.
template <int W>
WideTree<W> collapse(const BinaryTree& tree, MeshView mesh, std::uint32_t first_id, int threads);

extern template WideTree<4> collapse(const BinaryTree&, MeshView, std::uint32_t, int);
extern template WideTree<8> collapse(const BinaryTree&, MeshView, std::uint32_t, int);

}  // namespace plumb::detail
