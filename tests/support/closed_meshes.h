#pragma once

#include <string_view>
#include <vector>

#include "plumb/mesh.h"

namespace plumb::hard {

/// A closed surface whose vertices are integers of at most 2^12 in magnitude, shared by index, its faces
/// counter-clockwise seen from outside; no part of it meets another.
struct ClosedMesh {
  std::string_view name;
  TriangleMesh mesh;
};

/// A cube in squares, a ball, a torus, a spindle of slivers, two cones of a thousand triangles about an
/// axis, a tetrahedron, and a cube within a cube.
std::vector<ClosedMesh> closed_meshes();

/// Whether every directed edge is there once, and so is its reverse.
bool is_closed(const TriangleMesh& mesh);

}  // namespace plumb::hard
