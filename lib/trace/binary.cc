#include "trace/binary.h"

#include <utility>

namespace plumb::detail {

LeafTriangles leaf_triangles(const std::vector<std::uint32_t>& order, MeshView mesh, std::uint32_t first_id) {
  LeafTriangles leaves;
  leaves.triangles.reserve(order.size());
  leaves.ids.reserve(order.size());
  for (const std::uint32_t index : order) {
    const glm::uvec3& corners = mesh.triangles[index];
    leaves.triangles.push_back(
        {mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]});
    leaves.ids.push_back(first_id + index);
  }
  return leaves;
}

BinaryScene make_binary_scene(BinaryTree tree, MeshView mesh, std::uint32_t first_id) {
  BinaryScene scene;
  scene.leaves = leaf_triangles(tree.order, mesh, first_id);
  scene.nodes = std::move(tree.nodes);
  return scene;
}

QueryTable binary_queries(Simd) { return make_query_table<BinaryScene, BinaryTraversal<BinaryScene>>(); }

}  // namespace plumb::detail
