#pragma once

#include <cstdint>
#include <span>

#include <glm/vec3.hpp>

#include "build/binary_tree.h"
#include "plumb/mesh.h"

namespace plumb::detail {

struct Sphere {
  glm::vec3 center;
  float radius;  ///< infinite where a float cannot say it
};

/// A sphere that holds these triangles of the mesh, all finite, for certain; `box` is the triangles'. Its
/// radius is a few percent above the least.
Sphere bounding_sphere(MeshView mesh, std::span<const std::uint32_t> triangles, const Box& box);

}  // namespace plumb::detail
