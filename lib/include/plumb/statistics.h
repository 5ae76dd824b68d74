#pragma once

#include <cstddef>
#include <cstdint>

namespace plumb {

/// What a structure is like.
struct Statistics {
  std::size_t triangles = 0;         ///< in the mesh
  std::size_t unseen_triangles = 0;  ///< of these, left out: a coordinate is NaN or infinite
  std::size_t references = 0;        ///< of triangles: more than triangles where several leaves hold one
  std::size_t nodes = 0;             ///< inner nodes
  std::size_t leaves = 0;            ///< nodes that hold triangles
  int width = 0;                     ///< children per node
  int depth = 0;                     ///< nodes on the longest path from the root to a leaf
  double fill = 0;                   ///< used children, as a share of `nodes * width`
  double leaf_fill = 0;              ///< triangles in leaves, as a share of the lanes they take
  /// Boxes and triangles that a random line which meets the root's box is expected to be tested
  /// against, if nothing hides anything: the surface area heuristic (Goldsmith and Salmon 1987;
  /// MacDonald and Booth 1990). Each counts 1, whatever number a machine tests at once, so that trees
  /// of all widths compare.
  double sah_cost = 0;
  std::size_t bytes = 0;     ///< memory held, triangles included
  double build_seconds = 0;  ///< what the constructor took, by the wall clock
};

/// What rays were tested against.
struct TestCounts {
  std::uint64_t rays = 0;       ///< asked about
  std::uint64_t volumes = 0;    ///< boxes, spheres or cells, each child of a wide node for itself
  std::uint64_t triangles = 0;  ///< one twice where two leaves hold it
};

}  // namespace plumb
