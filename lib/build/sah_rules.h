#pragma once

#include <cstddef>

#include "build/binary_tree.h"

namespace plumb::detail {

/// What every builder that follows the surface area heuristic is told.
struct SahOptions {
  int max_leaf = 8;            ///< most triangles in a leaf, 1 to 255
  float node_cost = 1.0f;      ///< of testing a node's box pair, against...
  float triangle_cost = 1.0f;  ///< ...a block of `block` triangles
  int block = 1;               ///< triangles that one leaf test takes at once (SIMD lanes), a power of two
  /// Most nodes on a path, if halving alone can keep to it.
  int max_depth = kMaxTreeDepth;
};

/// What follows from the options for a range of triangles, however its split is searched.
class SahRules {
 public:
  /// Throws plumb::Error for an option out of range; `type` is the name of the options' type.
  SahRules(const SahOptions& options, const char* type);

  /// Leaf tests that the triangles take; a part of a block costs as much as the whole.
  std::size_t blocks(std::size_t triangles) const { return (triangles + block_ - 1) >> block_shift_; }
  int block_shift() const { return block_shift_; }

  bool may_be_leaf(std::size_t triangles) const { return triangles <= max_leaf_; }

  /// Whether the range is a leaf whatever its best split is: a split costs the test of its node at
  /// least.
  bool is_leaf_unsearched(std::size_t triangles) const;

  /// Whether a range so far down (`depth` nodes from the root, itself counted) must be halved, so that
  /// its leaves keep to max_depth. A better split may peel off only one triangle.
  bool must_be_halved(std::size_t triangles, int depth) const;

  /// Triangles of the left half, whole blocks where leaves hold so many.
  std::size_t left_half(std::size_t triangles) const { return (units(triangles) + 1) / 2 * unit_; }

 private:
  std::size_t units(std::size_t triangles) const { return (triangles + unit_ - 1) / unit_; }

  std::size_t max_leaf_;
  std::size_t block_;
  int block_shift_;
  std::size_t unit_;
  float node_cost_, triangle_cost_;
  int max_depth_;
};

/// Throws plumb::Error unless `holds`: option `name` (with its type) is `value`, but must be `range`.
void require_option(bool holds, const char* type, const char* name, double value, const char* range);

/// Most triangles, or references to them, of a tree.
inline constexpr std::size_t kMostTreeTriangles = 0x7fffffff;

/// Throws plumb::Error for more triangles than a tree's indices can tell apart: there may be twice as many
/// nodes.
void require_tree_size(std::size_t triangles);

}  // namespace plumb::detail
