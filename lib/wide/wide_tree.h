#pragma once

#include <cstddef>
#include <cstdint>

#include "base/aligned.h"
#include "build/binary_tree.h"
#include "wide/triangle_block.h"

namespace plumb::detail {

/// The index of no child.
inline constexpr std::uint32_t kNoChild = 0xffffffffu;

/// A node of W children with their boxes in SoA: `bounds[2 * axis][i]` is child i's least coordinate
/// on the axis, `bounds[2 * axis + 1][i]` the greatest, so that a ray picks near and far planes by
/// the sign of its direction alone.
///
/// Child i is empty (child[i] == kNoChild; its box is lo = +inf, hi = -inf, and empty children come
/// last), a node (count[i] == 0; child[i] indexes the tree's nodes) or a leaf of count[i] triangles,
/// the first lanes of consecutive blocks from child[i] on.
template <int W>
struct alignas(64) WideNode {
  float bounds[6][W];
  std::uint32_t child[W];
  std::uint32_t count[W];
};
static_assert(sizeof(WideNode<4>) == 128 && sizeof(WideNode<8>) == 256);

/// A tree of W-wide nodes; nodes[0] is the root. An empty scene has one node without children.
template <int W>
struct WideTree {
  static constexpr int kWidth = W;

  UnsetVector<WideNode<W>> nodes;
  UnsetVector<TriangleBlock<W>> blocks;
  Box box{};              ///< of all finite triangles; lo > hi when there is none
  float greatest = 0.0f;  ///< greatest |coordinate| among them
};

}  // namespace plumb::detail
