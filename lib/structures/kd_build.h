#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "build/binary_tree.h"
#include "plumb/mesh.h"
#include "structures/kd_scene.h"

namespace plumb::detail {

/// Costs are relative to each other, and tuned: on interiors, block costs of 0.6 to 1 and empty factors of
/// 0.8 and 0.9 give rays' times within 8 % of each other. Cheaper blocks make fewer cells and faster builds.
struct KdBuildOptions {
  double node_cost = 1.0;     ///< of stepping from a cell to one of its halves, against...
  double block_cost = 0.8;    ///< ...the test of a block of kKdLanes triangles
  double empty_factor = 0.8;  ///< times the cost of a plane that cuts off empty space
  /// The most references that splitting may add, as a share of the triangles: a bound for scenes of long
  /// triangles at a slant, which cells never part.
  double most_added = 8.0;
  int max_depth = kMaxKdDepth;  ///< most cells on a path
  int threads = 1;              ///< 0 takes all; the tree does not depend on it
};

/// A tree over the finite triangles of a mesh.
///
/// What its leaves promise: each cell on the way answers for some points of some triangles; the root for all
/// points of all. Of the points of a triangle that a cell answers for, its lower half answers for those up to
/// the plane if it keeps the triangle, and its upper half for those from the plane on if that one keeps it;
/// the half that does not keep it has none of these points, except such as lie in the plane itself, which the
/// other half has too. A leaf lists the triangles that it answers for. So whoever searches both halves for
/// points in their plane, as PlaneRay does, misses none.
struct KdTreeParts {
  Box box;
  float greatest = 0.0f;             ///< |coordinate|
  std::vector<KdNode> nodes;         ///< leaves say where in `order` their triangles are
  std::vector<std::uint32_t> order;  ///< indices into the mesh's triangles, each leaf's in the mesh's order
  std::size_t unseen = 0;
};

/// The surface area heuristic after Wald and Havran 2006: all planes where the triangles' parts in a cell,
/// clipped to it, begin or end are tried, in O(n log n) time. The indices must have been checked.
KdTreeParts build_kd_tree(MeshView mesh, const KdBuildOptions& options, Progress& progress);

}  // namespace plumb::detail
