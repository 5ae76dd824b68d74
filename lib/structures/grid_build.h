#pragma once

#include <cstddef>
#include <cstdint>

#include "base/parallel.h"
#include "plumb/mesh.h"
#include "structures/grid_scene.h"

namespace plumb::detail {

struct GridBuildOptions {
  double cells_per_triangle = 1.0;
  int threads = 0;
  std::uint32_t first_id = 0;
};

/// Lists each finite triangle in every cell that holds a point of it, and in few others: those that its box
/// meets and, where that is more than a handful, its plane. The indices must have been checked. Throws
/// Cancelled through `progress`, which is given the triangles done.
///
/// The number of cells falls below what the options ask for until the triangles' boxes meet no more than 32
/// cells a triangle on average, so that time and memory stay proportional to the triangles on any mesh.
GridScene build_grid(MeshView mesh, const GridBuildOptions& options, Progress& progress);

}  // namespace plumb::detail
