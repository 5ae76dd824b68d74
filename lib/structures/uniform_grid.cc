#include "plumb/uniform_grid.h"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "base/simd_dispatch.h"
#include "build/mesh_check.h"
#include "build/sah_rules.h"
#include "plumb/error.h"
#include "structures/grid_build.h"
#include "structures/grid_scene.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

using detail::GridScene;

void check_options(const UniformGridOptions& options) {
  detail::require_option(options.cells_per_triangle >= 0.001 && options.cells_per_triangle <= 1000.0,
                         "UniformGridOptions", "cells_per_triangle", options.cells_per_triangle,
                         "0.001 to 1000");
  detail::thread_count(options.threads);
}

Statistics grid_statistics(const GridScene& grid) {
  Statistics statistics;
  statistics.depth = grid.triangles.empty() ? 0 : 1;
  statistics.references = grid.refs.size();
  const std::size_t cells = grid.start.empty() ? 0 : grid.start.size() - 1;
  for (std::size_t i = 0; i < cells; ++i) statistics.leaves += grid.start[i + 1] > grid.start[i] ? 1 : 0;
  // Of the cells, those that hold something.
  statistics.fill = cells == 0 ? 0.0 : static_cast<double>(statistics.leaves) / static_cast<double>(cells);
  statistics.leaf_fill = grid.refs.empty() ? 0.0 : 1.0;
  statistics.width = static_cast<int>(std::min<std::size_t>(cells, 0x7fffffff));
  // A line that meets a box meets a cell with the chance of their areas' ratio.
  double area = 0.0, cell_area = 0.0;
  for (int a = 0; a < 3; ++a) {
    const detail::GridAxis &p = grid.axis[a], &q = grid.axis[(a + 1) % 3];
    const double whole = (p.hi - p.lo) * (q.hi - q.lo);
    area += whole;
    cell_area += whole / (static_cast<double>(p.cells) * static_cast<double>(q.cells));
  }
  const double chance = area > 0.0 ? cell_area / area : 1.0;
  statistics.sah_cost = chance * static_cast<double>(cells + grid.refs.size());
  statistics.bytes = grid.start.size() * sizeof(grid.start[0]) + grid.refs.size() * sizeof(grid.refs[0]) +
                     grid.triangles.size() * sizeof(grid.triangles[0]);
  return statistics;
}

std::shared_ptr<const detail::StructureData> build(MeshView mesh, const UniformGridOptions& options) {
  detail::check_mesh(mesh, options.first_id, "UniformGrid");
  detail::require_tree_size(mesh.triangles.size());
  check_options(options);
  const Simd simd = detail::resolve_simd(options.simd);
  const detail::BuildClock clock;
  std::shared_ptr<detail::StructureData> data;
  detail::with_default_fp_mode([&] {
    detail::Progress progress(options.progress, mesh.triangles.size());
    GridScene grid =
        detail::build_grid(mesh, {options.cells_per_triangle, options.threads, options.first_id}, progress);
    Statistics statistics = grid_statistics(grid);
    statistics.triangles = mesh.triangles.size();
    statistics.unseen_triangles = mesh.triangles.size() - grid.triangles.size();
    data = detail::make_structure_data(std::move(grid), detail::grid_queries, simd);
    data->statistics = statistics;
  });
  data->statistics.build_seconds = clock.seconds();
  return data;
}

}  // namespace

UniformGrid::UniformGrid(MeshView mesh, const UniformGridOptions& options)
    : Structure(build(mesh, options)) {}

}  // namespace plumb
