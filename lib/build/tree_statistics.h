#pragma once

#include "build/binary_tree.h"
#include "plumb/bvh.h"
#include "wide/wide_tree.h"

namespace plumb::detail {

/// What a tree is like: all of Statistics but `triangles`, `unseen_triangles` and `build_seconds`, which
/// a wide tree does not know.
///
/// `nodes` counts inner nodes and `leaves` leaves; a leaf at the root of a binary tree has no inner node
/// above it, at the root of a wide one it has. `depth` counts inner nodes and the leaf. `fill` is 1 for
/// a binary tree. Lanes are counted in blocks of W triangles, of one for a binary tree.
///
/// `sah_cost` follows Goldsmith and Salmon 1987, "Automatic Creation of Object Hierarchies for Ray
/// Tracing", and MacDonald and Booth 1990, "Heuristics for ray tracing using space subdivision": a random
/// line that meets a convex box meets another inside it with the chance
/// p = (area of the inner) / (area of the outer). So a line that meets the root's box is expected to
/// be tested against
///
///     sum over inner nodes of p(node) * (its children)  +  sum over leaves of p(leaf) * (its triangles)
///
/// boxes and triangles, if nothing is ever hidden. Each counts 1, whatever number a machine tests at
/// once, so that trees of all widths compare. Where the root's box has no area p is 1.
Statistics tree_statistics(const BinaryTree& tree);

/// Defined for W = 4 and 8.
template <int W>
Statistics tree_statistics(const WideTree<W>& tree);

extern template Statistics tree_statistics(const WideTree<4>&);
extern template Statistics tree_statistics(const WideTree<8>&);

}  // namespace plumb::detail
