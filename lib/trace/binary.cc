#include "trace/binary.h"

#include <utility>

#include "trace/box_ray.h"

namespace plumb::detail {
namespace {

struct BinaryTraversal {
  template <typename Query>
  static void run(const BinaryScene& scene, const Ray& ray, Query& query) {
    const std::vector<BinaryNode>& nodes = scene.tree.nodes;
    const ExactBoxRay box_ray(ray);
    struct Entry {
      float near;
      std::uint32_t node;
    };
    Entry stack[kMaxTreeDepth + 1];
    int size = 0;
    const auto push_if_met = [&](std::uint32_t index) {
      const Box& box = nodes[index].box;
      Entry entry{0.0f, index};
      query.count_volumes(1);
      if (box_ray.meets(&box.lo.x, &box.hi.x, query.limit(), entry.near)) stack[size++] = entry;
    };
    if (!nodes.empty()) push_if_met(0);
    while (size > 0) {
      const Entry entry = stack[--size];
      if (entry.near > query.limit()) continue;
      const BinaryNode& node = nodes[entry.node];
      if (node.count != 0) {
        if (test_leaf(scene, node, ray, query)) return;
        continue;
      }
      const int before = size;
      push_if_met(node.first);
      push_if_met(node.first + 1);
      // The nearer child comes off the stack first.
      if (size == before + 2 && stack[before].near < stack[before + 1].near) {
        std::swap(stack[before], stack[before + 1]);
      }
    }
  }

  template <typename Query>
  static bool test_leaf(const BinaryScene& scene, const BinaryNode& node, const Ray& ray, Query& query) {
    query.count_triangles(node.count);
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
      float t = 0.0f;
      if (line_hit(ray.origin, ray.direction, scene.triangles[i], t) && query.take(t, scene.ids[i]))
        return true;
    }
    return false;
  }
};

}  // namespace

BinaryScene make_binary_scene(BinaryTree tree, MeshView mesh, std::uint32_t first_id) {
  BinaryScene scene;
  scene.triangles.reserve(tree.order.size());
  scene.ids.reserve(tree.order.size());
  for (const std::uint32_t index : tree.order) {
    const glm::uvec3& corners = mesh.triangles[index];
    scene.triangles.push_back(
        {mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]});
    scene.ids.push_back(first_id + index);
  }
  scene.tree = std::move(tree);
  return scene;
}

QueryTable binary_queries(Simd) { return make_query_table<BinaryScene, BinaryTraversal>(); }

}  // namespace plumb::detail
