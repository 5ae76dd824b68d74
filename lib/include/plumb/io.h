#pragma once

#include <cstddef>
#include <filesystem>

#include "plumb/mesh.h"

namespace plumb {

/// What a mesh file held.
struct MeshReport {
  std::size_t vertices = 0;             ///< positions, used or not
  std::size_t faces = 0;                ///< as in the file, before polygons became triangles
  std::size_t triangles = 0;            ///< in the mesh
  std::size_t non_finite_vertices = 0;  ///< a coordinate is NaN or infinite
  std::size_t unseen_triangles = 0;     ///< triangles with such a vertex: kept, never seen
};

/// Reads a mesh file: PLY (ascii, both byte orders), OBJ, STL (text or binary) or OFF, told by the file's
/// extension (any case). Ids follow file order; a polygon v0 v1 ... vk becomes (v0, vi, vi+1); coordinates
/// are rounded once to the nearest float; nothing is welded, moved or dropped (docs/visibility.md). Throws
/// plumb::Error that names the file, the place in it and what is wrong. Link plumb::io.
TriangleMesh load_mesh(const std::filesystem::path& path, MeshReport* report = nullptr);

}  // namespace plumb
