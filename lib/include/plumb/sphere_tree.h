#pragma once

#include <cstdint>
#include <functional>

#include "plumb/mesh.h"
#include "plumb/structure.h"

namespace plumb {

/// How a SphereTree is built.
struct SphereTreeOptions {
  /// Threads for the build; 0 takes all that the affinity mask allows. The tree does not depend on it.
  int threads = 0;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene. All ids must be
  /// below kNone.
  std::uint32_t first_id = 0;
  /// As BuildOptions::progress.
  std::function<bool(double)> progress = nullptr;
};

/// A hierarchy of bounding spheres, in plain scalar code.
///
/// It is the Bvh of width 2 with a sphere around every node's triangles in place of the box (Rubin and
/// Whitted 1980, "A 3-dimensional representation for fast rendering of complex scenes", had such hierarchies;
/// Ritter 1990, "An Efficient Bounding Sphere", such spheres): the two differ in their volumes alone. A
/// sphere takes four numbers for a box's six, but holds flat and long things badly, and meeting a sphere
/// costs a square root. Almost always the boxes win; docs/structures.md has the figures.
class SphereTree : public Structure {
 public:
  /// Copies what it needs of the mesh. Triangles with a NaN or infinite coordinate are left out, and counted
  /// in statistics(), whose sah_cost has the spheres' areas. Throws what Bvh throws.
  explicit SphereTree(MeshView mesh, const SphereTreeOptions& options = {});
};

}  // namespace plumb
