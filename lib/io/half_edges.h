#pragma once

#include <cstddef>

#include "io/cover.h"
#include "io/disjoint_sets.h"

namespace plumb::detail {

/// What a surface is as a whole.
struct SurfaceCounts {
  std::size_t boundary_loops = 0;           ///< closed paths of the boundary
  std::ptrdiff_t euler_characteristic = 0;  ///< vertices - edges + triangles
};

/// Counts them on OpenMesh's half-edges, of which each fan becomes a vertex. `fans` are the cover's.
SurfaceCounts count_surface(const Cover& cover, DisjointSets& fans);

}  // namespace plumb::detail
