#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "build/binary_tree.h"
#include "plumb/mesh.h"
#include "wide/wide_tree.h"

// What must hold of every tree, whoever built it. Each function returns what does not, in words, at
// most kMaxViolations of them; an empty list means that all holds. They read nothing out of
// bounds, however broken the tree.

namespace plumb::detail {

inline constexpr std::size_t kMaxViolations = 32;

/// What leaves hold of a triangle.
enum class References {
  Once,     ///< the whole of it, in one leaf
  Several,  ///< parts of it, in one leaf or more
};

/// Every finite triangle is in one leaf; boxes are those of the triangles below, to the bit; every node
/// but the root is the child of one that comes before it; leaves hold at most `max_leaf` triangles;
/// no path has more than kMaxTreeDepth nodes; `unseen` counts the triangles that are not finite.
///
/// With References::Several a triangle may be in more than one leaf, but not twice in one; a leaf's box is
/// within that of its triangles, others are those of their children, and the boxes of a triangle's leaves
/// cover it, but for what rounding may do to this check.
std::vector<std::string> check_tree(const BinaryTree& tree, MeshView mesh, int max_leaf,
                                    References references = References::Once);

/// The same of a wide tree, with its blocks: vertices and ids are the mesh's, extents are bounds,
/// lanes past a leaf's count are zero, every block belongs to one leaf, empty children come last.
/// Defined for W = 4 and 8.
template <int W>
std::vector<std::string> check_tree(const WideTree<W>& tree, MeshView mesh, std::uint32_t first_id,
                                    int max_leaf, References references = References::Once);

extern template std::vector<std::string> check_tree(const WideTree<4>&, MeshView, std::uint32_t, int,
                                                    References);
extern template std::vector<std::string> check_tree(const WideTree<8>&, MeshView, std::uint32_t, int,
                                                    References);

}  // namespace plumb::detail
