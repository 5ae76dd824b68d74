#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "base/aligned.h"
#include "build/binary_tree.h"
#include "plumb/simd.h"
#include "trace/query.h"
#include "wide/triangle_block.h"

namespace plumb::detail {

/// The most cells on a path from the root to a leaf, both counted, so that the traversal's stack is an array.
inline constexpr int kMaxKdDepth = 96;

/// Triangles that a leaf tests at once. With 4 the tree has more and smaller cells: a third more memory and
/// build time, and rays take from as long to half as long again.
inline constexpr int kKdLanes = 8;

/// A cell of a k-d tree. Its halves are closed: both have the points of the plane between them. The nodes
/// come in depth-first order: the lower half of nodes[i] is nodes[i + 1].
class KdNode {
 public:
  static KdNode inner(int axis, float plane, std::uint32_t upper) {
    return KdNode(std::bit_cast<std::uint32_t>(plane), upper << 2 | static_cast<std::uint32_t>(axis));
  }
  /// `first` is the first reference of a tree that is being built, or the first block of a finished one.
  static KdNode leaf(std::uint32_t first, std::uint32_t count) { return KdNode(first, count << 2 | kLeaf); }

  bool is_leaf() const { return (tag_ & 3u) == kLeaf; }
  int axis() const { return static_cast<int>(tag_ & 3u); }
  float plane() const { return std::bit_cast<float>(word_); }
  std::uint32_t upper() const { return tag_ >> 2; }
  std::uint32_t first() const { return word_; }
  std::uint32_t count() const { return tag_ >> 2; }

 private:
  static constexpr std::uint32_t kLeaf = 3;
  KdNode(std::uint32_t word, std::uint32_t tag) : word_(word), tag_(tag) {}

  std::uint32_t word_;
  std::uint32_t tag_;  // the axis or kLeaf, and above it the upper half or the number of triangles
};
static_assert(sizeof(KdNode) == 8);

/// A k-d tree with its triangles. Without a triangle it has no node.
struct KdScene {
  Box box;                ///< of the root: the smallest around all finite triangles
  float greatest = 0.0f;  ///< |coordinate| of these
  std::vector<KdNode> nodes;
  AlignedVector<TriangleBlock<kKdLanes>> blocks;  ///< of each leaf, one after the other
};

/// The queries over a KdScene, for a resolved target.
QueryTable kd_queries(Simd simd);

}  // namespace plumb::detail
