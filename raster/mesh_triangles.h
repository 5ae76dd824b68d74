#pragma once

#include <cstdint>

#include "exact/intersect.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// A mesh's triangles as tiles are drawn from them (pixels/tile_settle-inl.h).
struct MeshTriangles {
  MeshView mesh;
  std::uint32_t first_id;

  std::uint32_t id(std::uint32_t index) const { return first_id + index; }
  Triangle corners(std::uint32_t index) const {
    const glm::uvec3& c = mesh.triangles[index];
    return {mesh.positions[c.x], mesh.positions[c.y], mesh.positions[c.z]};
  }
};

}  // namespace plumb::detail
