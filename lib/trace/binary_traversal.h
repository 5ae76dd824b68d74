#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "build/binary_tree.h"
#include "exact/intersect.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// The triangles of a binary tree in leaf order.
struct LeafTriangles {
  std::vector<Triangle> triangles;  ///< triangles[i] is that of order[i]
  std::vector<std::uint32_t> ids;
};

inline std::size_t bytes_of(const LeafTriangles& leaves) {
  return leaves.ids.size() * (sizeof(Triangle) + sizeof(std::uint32_t));
}

LeafTriangles leaf_triangles(const std::vector<std::uint32_t>& order, MeshView mesh, std::uint32_t first_id);

/// Binary trees in plain scalar code, front to back, whatever the volume of a node is. A scene has
///
///     nodes      in the order of BinaryTree's, each with first and count
///     leaves     LeafTriangles
///     VolumeRay  made of a ray; meets(node, limit, near) is as ExactBoxRay's
template <typename Scene>
struct BinaryTraversal {
  template <typename Query>
  static void run(const Scene& scene, const Ray& ray, Query& query) {
    const auto& nodes = scene.nodes;
    const typename Scene::VolumeRay volume_ray(ray);
    struct Entry {
      float near;
      std::uint32_t node;
    };
    Entry stack[kMaxTreeDepth + 1];
    int size = 0;
    const auto push_if_met = [&](std::uint32_t index) {
      Entry entry{0.0f, index};
      query.count_volumes(1);
      if (volume_ray.meets(nodes[index], query.limit(), entry.near)) stack[size++] = entry;
    };
    if (!nodes.empty()) push_if_met(0);
    while (size > 0) {
      const Entry entry = stack[--size];
      if (entry.near > query.limit()) continue;
      const auto& node = nodes[entry.node];
      if (node.count != 0) {
        if (test_leaf(scene.leaves, node.first, node.count, ray, query)) return;
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

 private:
  template <typename Query>
  static bool test_leaf(const LeafTriangles& leaves, std::uint32_t first, std::uint32_t count, const Ray& ray,
                        Query& query) {
    query.count_triangles(count);
    for (std::uint32_t i = first; i < first + count; ++i) {
      float t = 0.0f;
      if (ray_hit(ray, leaves.triangles[i], false, query.limit(), t) && query.take(t, leaves.ids[i]))
        return true;
    }
    return false;
  }
};

}  // namespace plumb::detail
