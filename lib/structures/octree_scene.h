#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "base/aligned.h"
#include "build/binary_tree.h"
#include "plumb/simd.h"
#include "trace/query.h"
#include "wide/triangle_block.h"

namespace plumb::detail {

/// The most cells on a path from the root to a leaf, both counted, so that the traversal's stack is an array.
inline constexpr int kMaxOctreeDepth = 32;
inline constexpr int kOctreeLanes = 8;

/// A cell of an octree. Inner: `count` is kInner, and child i is the node first + i; bit a of i is set for
/// the half that is the greater along axis a. The halves are closed, and meet in `middle`. Leaf: triangles of
/// the blocks from `first` on.
struct OctreeNode {
  static constexpr std::uint32_t kInner = 0xffffffffu;

  glm::vec3 middle;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

/// An octree with its triangles. nodes[0] is the root; without a triangle there is none.
struct OctreeScene {
  Box box{};              ///< of the root: the smallest around all finite triangles
  float greatest = 0.0f;  ///< |coordinate| of these
  std::vector<OctreeNode> nodes;
  AlignedVector<TriangleBlock<kOctreeLanes>> blocks;  ///< of each leaf, one after the other
};

/// The half of a cell that is child i, with the cell's middle.
inline Box octree_child(const Box& cell, const glm::vec3& middle, int i) {
  Box child = cell;
  for (int axis = 0; axis < 3; ++axis) {
    if ((i >> axis & 1) != 0) {
      child.lo[axis] = middle[axis];
    } else {
      child.hi[axis] = middle[axis];
    }
  }
  return child;
}

/// The queries over an OctreeScene, for a resolved target.
QueryTable octree_queries(Simd simd);

}  // namespace plumb::detail
