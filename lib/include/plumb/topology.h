#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "plumb/mesh.h"

namespace plumb {

/// How a mesh hangs together, and what is odd about it.
///
/// Vertices at equal positions count as one (-0 equals +0), for many files have each triangle's own; nothing
/// is closer to another than equal. Non-finite triangles, and collapsed ones, are counted and then left out.
struct Topology {
  std::size_t positions = 0;  ///< different ones that the triangles use
  std::size_t triangles = 0;  ///< those left: finite, of three different positions

  std::size_t non_finite = 0;  ///< triangles with a NaN or infinite coordinate
  std::size_t collapsed = 0;   ///< triangles with two equal positions
  std::size_t degenerate = 0;  ///< triangles of no area, exactly; collapsed ones among them
  std::size_t duplicates = 0;  ///< triangles left with the same positions as an earlier one, in any order
  std::size_t unused_vertices = 0;    ///< vertices of the mesh that no triangle uses
  std::size_t repeated_vertices = 0;  ///< used vertices at the position of an earlier one

  std::size_t edges = 0;               ///< different pairs of positions that triangles have as a side
  std::size_t boundary_edges = 0;      ///< of one triangle
  std::size_t non_manifold_edges = 0;  ///< of three triangles or more
  std::size_t odd_edges = 0;           ///< of an odd number of triangles, boundary edges among them
  std::size_t turned_edges = 0;        ///< of two triangles, but run through the same way by both
  std::size_t non_manifold_positions =
      0;  ///< whose triangles, joined by edges of two, are no single fan or ring

  /// Triangles with a side on a non-manifold or turned edge. Half-edges, OpenMesh's among them, cannot hold
  /// these as they are.
  std::size_t unjoined_triangles = 0;
  std::vector<std::uint32_t>
      first_unjoined;  ///< indices in the mesh of the first of them, at most kMaxListed

  std::size_t components = 0;  ///< parts whose triangles are joined by edges
  /// Of the surface taken apart at non-manifold edges and positions: the closed paths of its boundary.
  std::size_t boundary_loops = 0;
  /// Of the same: vertices - edges + triangles. 2 for a sphere, 0 for a torus, one less for each hole.
  std::ptrdiff_t euler_characteristic = 0;

  /// How many triangles are listed at most.
  static constexpr std::size_t kMaxListed = 16;
  /// A line crosses it an even number of times: every edge belongs to an even number of triangles.
  bool closed() const { return triangles != 0 && odd_edges == 0; }
  /// About every point it is a disk or half a disk.
  bool manifold() const { return non_manifold_edges == 0 && non_manifold_positions == 0; }
  /// Neighbours agree which side is the front.
  bool oriented() const { return turned_edges == 0 && non_manifold_edges == 0; }
};

/// Analyses a mesh, with OpenMesh's half-edges. Takes about n log n time for n triangles, and some 170 bytes
/// for each, or 320 where triangles disagree which side is the front. `progress` is as in BuildOptions.
/// Throws plumb::Error for a vertex index out of range and more than 150 million triangles, and Cancelled.
/// Link plumb::io.
Topology topology(MeshView mesh, const std::function<bool(double)>& progress = nullptr);

}  // namespace plumb
