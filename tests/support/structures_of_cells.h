#pragma once

#include <vector>

#include "plumb/kd_tree.h"
#include "plumb/octree.h"
#include "plumb/sphere_tree.h"
#include "plumb/structure.h"
#include "plumb/uniform_grid.h"

namespace plumb {

/// What there is beside the trees of boxes: structures of cells, and the tree of spheres.
inline std::vector<Structure> structures_of_cells(const TriangleMesh& mesh) {
  return {KdTree(mesh), UniformGrid(mesh), Octree(mesh), SphereTree(mesh)};
}

}  // namespace plumb
