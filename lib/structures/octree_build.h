#pragma once

#include <cstdint>
#include <vector>

#include "base/parallel.h"
#include "plumb/mesh.h"
#include "structures/octree_scene.h"

namespace plumb::detail {

/// A built octree, whose leaves hold order[first] ... order[first + count - 1].
struct OctreeParts {
  Box box{};
  std::vector<OctreeNode> nodes;
  std::vector<std::uint32_t> order;  ///< indices into the mesh's triangles
  std::size_t triangles = 0;         ///< finite ones
};

/// Builds an octree. The indices must have been checked. Throws Cancelled through `progress`, which is given
/// the triangles done.
///
/// Every cell answers for what lies in it: each point of a finite triangle in the root's box is in a closed
/// leaf that has the triangle. A point in a plane between halves is in both, and one of them has it, so that
/// a traversal must look on both sides of it (structures/plane_ray.h).
///
/// A cell is cut as long as it has more triangles than a leaf tests at once, its halves are not copies of it,
/// and the copies that its path has made stay below kMostCopies a triangle; and to a depth of
/// kMaxOctreeDepth. So time and memory are proportional to the triangles on any mesh.
OctreeParts build_octree(MeshView mesh, Progress& progress);

}  // namespace plumb::detail
