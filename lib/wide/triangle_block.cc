#include "wide/triangle_block.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/vec3.hpp>

namespace plumb::detail {

// TriangleBlock::extent. The sum is exact but for the last bits of a double, far inside the slack that
// covers it and any order of summing in float; a difference that overflows makes it infinite.
float triangle_extent(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  const auto length = [&](const glm::vec3& to) {
    return (double{std::fabs(to.x - v0.x)} + double{std::fabs(to.y - v0.y)}) + double{std::fabs(to.z - v0.z)};
  };
  const double greatest = std::max(length(v1), length(v2)) * (1.0 + 4 * 0x1p-24);
  if (greatest > double{std::numeric_limits<float>::max()}) return std::numeric_limits<float>::infinity();
  return std::max(static_cast<float>(greatest), 0x1p-30f);
}

template <int W>
void set_triangle(TriangleBlock<W>& block, std::size_t lane, MeshView mesh, std::uint32_t index,
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

template void set_triangle(TriangleBlock<4>&, std::size_t, MeshView, std::uint32_t, std::uint32_t);
template void set_triangle(TriangleBlock<8>&, std::size_t, MeshView, std::uint32_t, std::uint32_t);

}  // namespace plumb::detail
