#pragma once

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
float triangle_extent(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2);

/// Fills a lane with the mesh's triangle `index`, whose id will be first_id + index. The triangle must be
/// finite.
template <int W>
void set_triangle(TriangleBlock<W>& block, std::size_t lane, MeshView mesh, std::uint32_t index,
                  std::uint32_t first_id);

extern template void set_triangle(TriangleBlock<4>&, std::size_t, MeshView, std::uint32_t, std::uint32_t);
extern template void set_triangle(TriangleBlock<8>&, std::size_t, MeshView, std::uint32_t, std::uint32_t);

}  // namespace plumb::detail
