#pragma once

#include <cstdint>
#include <vector>

#include "build/binary_tree.h"
#include "exact/intersect.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "trace/query.h"

namespace plumb::detail {

/// A binary tree with its triangles in leaf order: the plain scalar reference beside the wide trees.
struct BinaryScene {
  BinaryTree tree;
  std::vector<Triangle> triangles;  ///< triangles[i] is that of tree.order[i]
  std::vector<std::uint32_t> ids;
};

BinaryScene make_binary_scene(BinaryTree tree, MeshView mesh, std::uint32_t first_id);

/// The queries over a BinaryScene, in scalar code.
QueryTable binary_queries(Simd);

}  // namespace plumb::detail
