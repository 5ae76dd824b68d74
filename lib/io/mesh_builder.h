#pragma once

#include <cstddef>
#include <cstdint>

#include "plumb/io.h"
#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb::detail {

/// How much a reader may produce. The defaults are what 32-bit indices and ids can name.
struct MeshLimits {
  std::uint64_t vertices = kNone;
  std::uint64_t triangles = kNone;  // ids 0 to kNone - 1
};

/// Collects a mesh in file order; polygons become fans.
class MeshBuilder {
 public:
  explicit MeshBuilder(const MeshLimits& limits) : limits_(limits) {}

  const MeshLimits& limits() const { return limits_; }
  TriangleMesh& mesh() { return mesh_; }

  /// Makes room for a mesh whose counts are known to fit the file.
  void reserve(std::uint64_t vertices, std::uint64_t triangles);

  void begin_polygon() { corners_ = 0; }

  /// Adds a corner v to the polygon v0 v1 ...: from the third on it makes the triangle (v0, last, v).
  /// False when that triangle would have no id.
  bool add_corner(std::uint32_t vertex) {
    if (corners_ == 0) first_ = vertex;
    if (corners_ >= 2) {
      if (mesh_.triangles.size() >= limits_.triangles) return false;
      mesh_.triangles.emplace_back(first_, last_, vertex);
    }
    last_ = vertex;
    ++corners_;
    return true;
  }

  /// Corners of the polygon so far.
  std::uint64_t corners() const { return corners_; }

  void end_polygon() { ++faces_; }

  /// The report on the mesh as it stands.
  MeshReport report() const;

 private:
  MeshLimits limits_;
  TriangleMesh mesh_;
  std::size_t faces_ = 0;
  std::uint64_t corners_ = 0;
  std::uint32_t first_ = 0;
  std::uint32_t last_ = 0;
};

}  // namespace plumb::detail
