#pragma once

#include "base/parallel.h"
#include "build/binary_tree.h"
#include "plumb/mesh.h"

namespace plumb::detail {

struct BinnedSahOptions {
  int bins = 32;               ///< per axis, 8 to 32
  int max_leaf = 8;            ///< most triangles in a leaf, 1 to 255
  float node_cost = 1.0f;      ///< of testing a node's box pair, against...
  float triangle_cost = 1.0f;  ///< ...a block of `block` triangles
  int block = 1;               ///< triangles that one leaf test takes at once (SIMD lanes)
  int threads = 0;
};

/// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies": the surface area
/// heuristic over bins of centroids. The indices must have been checked. Throws Cancelled through
/// `progress`.
BinaryTree build_binned_sah(MeshView mesh, const BinnedSahOptions& options, Progress& progress);

}  // namespace plumb::detail
