#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <glm/vec3.hpp>

#include "plumb/mesh.h"

namespace plumb::detail {

/// W triangles in SoA: `vertex[v][axis][lane]`, as they came from the mesh. Lanes past the leaf's
/// count are zero and must be masked off.
template <int W>
struct alignas(W * sizeof(float)) TriangleBlock {
  float vertex[3][3][W];
  /// An upper bound of max(|v1 - v0|_1, |v2 - v0|_1) as computed in float, at least 2^-30: the term L
  /// of the float filter's bound (exact/filter-inl.h).
  float extent[W];
  std::uint32_t id[W];
};

/// TriangleBlock::extent of a triangle.
///
/// The two sums are rounded, and so is the product: of the exact sum of the computed differences it is at
/// least (1 - u)^3 (1 + 8 u) times, u = 2^-24, and so above that sum in any order, which is at most (1 + u)^2
/// times.
inline float triangle_extent(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  const auto length = [&](const glm::vec3& to) {
    return (std::fabs(to.x - v0.x) + std::fabs(to.y - v0.y)) + std::fabs(to.z - v0.z);
  };
  return std::max(std::max(length(v1), length(v2)) * (1.0f + 8 * 0x1p-24f), 0x1p-30f);
}

/// Fills a lane with the mesh's triangle `index`, whose id will be first_id + index. The triangle must be
/// finite.
template <int W>
inline void set_triangle(TriangleBlock<W>& block, std::size_t lane, MeshView mesh, std::uint32_t index,
                         std::uint32_t first_id) {
  const glm::uvec3& corners = mesh.triangles[index];
  const glm::vec3 vertex[3] = {mesh.positions[corners.x], mesh.positions[corners.y],
                               mesh.positions[corners.z]};
  for (int v = 0; v < 3; ++v) {
    for (int axis = 0; axis < 3; ++axis) block.vertex[v][axis][lane] = vertex[v][axis];
  }
  block.extent[lane] = triangle_extent(vertex[0], vertex[1], vertex[2]);
  block.id[lane] = first_id + index;
}

}  // namespace plumb::detail
