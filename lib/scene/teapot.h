#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "plumb/mesh.h"

namespace plumb::detail {

/// A control point in units of 1/kTeapotUnits: in these, all published coordinates are integers.
inline constexpr int kTeapotUnits = 4000;
struct TeapotPoint {
  std::int64_t x, y, z;
};

/// A bicubic Bezier patch, row after row of four.
using TeapotPatch = std::array<TeapotPoint, 16>;

/// The 32 patches in their published order: rim and body, handle, spout, lid, bottom.
std::vector<TeapotPatch> teapot_patches();

/// The finest that append_teapot can make.
inline constexpr int kMaxTeapotSegments = 256;

/// Appends the teapot, each patch in `segments` x `segments` quads: 64 segments^2 - 8 segments
/// triangles, for the quads at the lid's and the bottom's centre are triangles. y is up, the spout points
/// to +z, the bottom's centre is at `foot`; the teapot is about 6.5 `scale` long and 3.15 `scale` high.
/// Where patches meet, their vertices are equal.
void append_teapot(TriangleMesh& mesh, int segments, const glm::dvec3& foot, double scale);

}  // namespace plumb::detail
