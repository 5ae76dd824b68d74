#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "plumb/io.h"
#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb::detail {

/// How much a reader may produce. The defaults are what 32-bit indices and ids can name.
struct MeshLimits {
  std::uint64_t vertices = kNone;
  std::uint64_t triangles = kNone;  // ids 0 to kNone - 1
  std::uint64_t first_id = 0;       // where the ids begin that leave so few triangles
};

/// The reason why a mesh has too many triangles.
std::string too_many_triangles(const MeshLimits& limits);

/// Makes a mesh from what a reader finds, in file order; polygons become fans. `Mesh` keeps it, as WholeMesh
/// does, or passes it on.
template <class Mesh>
class MeshBuilder {
 public:
  explicit MeshBuilder(const MeshLimits& limits, Mesh mesh = {}) : limits_(limits), mesh_(std::move(mesh)) {}

  const MeshLimits& limits() const { return limits_; }
  Mesh& mesh() { return mesh_; }

  /// Vertices so far.
  std::uint64_t vertices() const { return mesh_.vertices(); }

  /// Makes room for a mesh whose counts are known to fit the file.
  void reserve(std::uint64_t vertices, std::uint64_t triangles) { mesh_.reserve(vertices, triangles); }

  void add_vertex(const glm::vec3& position) { mesh_.add_vertex(position); }

  void begin_polygon() { corners_ = 0; }

  /// Adds a corner v to the polygon v0 v1 ...: from the third on it makes the triangle (v0, last, v).
  /// False when that triangle would have no id.
  bool add_corner(std::uint32_t vertex) {
    if (corners_ == 0) first_ = vertex;
    if (corners_ >= 2) {
      if (mesh_.triangles() >= limits_.triangles) return false;
      mesh_.add_triangle(first_, last_, vertex);
    }
    last_ = vertex;
    ++corners_;
    return true;
  }

  /// Adds a polygon of three corners at once. False, and nothing added, when it would have no id.
  bool add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (mesh_.triangles() >= limits_.triangles) return false;
    mesh_.add_triangle(a, b, c);
    ++faces_;
    return true;
  }

  /// Corners of the polygon so far.
  std::uint64_t corners() const { return corners_; }

  void end_polygon() { ++faces_; }

  /// The report on the mesh as it stands.
  MeshReport report() const {
    MeshReport report = mesh_.report();
    report.faces = faces_;
    return report;
  }

 private:
  MeshLimits limits_;
  Mesh mesh_;
  std::size_t faces_ = 0;
  std::uint64_t corners_ = 0;
  std::uint32_t first_ = 0;
  std::uint32_t last_ = 0;
};

/// A mesh kept in memory.
class WholeMesh {
 public:
  std::uint64_t vertices() const { return mesh_.positions.size(); }
  std::uint64_t triangles() const { return mesh_.triangles.size(); }
  void reserve(std::uint64_t vertices, std::uint64_t triangles);
  void add_vertex(const glm::vec3& position) { mesh_.positions.push_back(position); }
  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.triangles.emplace_back(a, b, c);
  }

  /// The report but for the faces.
  MeshReport report() const;
  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
};

}  // namespace plumb::detail
