#pragma once

#include <cstdint>
#include <vector>

#include "build/binary_tree.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "trace/binary_traversal.h"
#include "trace/box_ray.h"
#include "trace/query.h"

namespace plumb::detail {

/// A binary tree with its triangles in leaf order: the plain scalar reference beside the wide trees.
struct BinaryScene {
  struct VolumeRay : ExactBoxRay {
    using ExactBoxRay::ExactBoxRay;
    bool meets(const BinaryNode& node, float limit, float& near) const {
      return ExactBoxRay::meets(&node.box.lo.x, &node.box.hi.x, limit, near);
    }
  };

  std::vector<BinaryNode> nodes;
  LeafTriangles leaves;
};

BinaryScene make_binary_scene(BinaryTree tree, MeshView mesh, std::uint32_t first_id);

/// The queries over a BinaryScene, in scalar code.
QueryTable binary_queries(Simd);

}  // namespace plumb::detail
