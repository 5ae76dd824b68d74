#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// How an Octree is built and queried.
struct OctreeOptions {
  /// Threads for the build; 0 takes all that the affinity mask allows. The tree does not depend on it.
  int threads = 0;
  /// Instruction set of the queries; must be Auto or one of simd_targets().
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene. All ids must be
  /// below kNone.
  std::uint32_t first_id = 0;
  /// As BuildOptions::progress.
  std::function<bool(double)> progress = nullptr;
};

/// An adaptive octree: the scene's box is halved along all three axes at once, and each part again as long as
/// it holds many triangles (Glassner 1984, "Space Subdivision for Fast Ray Tracing"). A ray takes the parts
/// front to back, in the order that the signs of its direction give.
///
/// A triangle is kept in every cell that it has a part in. Cells are cut in the middle, wherever the
/// triangles are: the tree is quicker to build than a KdTree and slower to ask.
class Octree : public Structure {
 public:
  /// Copies what it needs of the mesh. Triangles with a NaN or infinite coordinate are left out, and counted
  /// in statistics(). Throws plumb::Error for a vertex index out of range, ids that reach kNone, 2^28
  /// triangles and more, and options out of range, and Cancelled when the options' progress says so.
  explicit Octree(MeshView mesh, const OctreeOptions& options = {});

  /// As Structure::with_simd.
  Octree with_simd(Simd simd) const { return Octree(Structure::with_simd(simd)); }

 private:
  explicit Octree(Structure structure) : Structure(std::move(structure)) {}
};

}  // namespace plumb
