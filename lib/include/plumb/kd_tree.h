#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// How a KdTree is built and queried.
struct KdTreeOptions {
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

/// A k-d tree: planes across the axes cut the scene's box into cells, and each cell that no plane cuts knows
/// the triangles in it.
///
/// Built by the surface area heuristic over all planes at which a triangle's part in a cell begins or ends,
/// with a bonus for cutting off empty space, in n log n time (Wald and Havran 2006, "On building fast
/// kd-Trees for Ray Tracing, and on doing that in O(N log N)"). A ray meets the cells in order and stops at
/// the first hit that no later cell can beat. Cells fit a scene more closely than boxes around whole
/// triangles do, but a triangle is kept in every cell it is in, so that a build takes more time and memory
/// than a Bvh's.
class KdTree : public Structure {
 public:
  /// Copies what it needs of the mesh. Triangles with a NaN or infinite coordinate are left out, and counted
  /// in statistics(). Throws plumb::Error for a vertex index out of range, ids that reach kNone, 2^28
  /// triangles and more, and options out of range, and Cancelled when the options' progress says so.
  explicit KdTree(MeshView mesh, const KdTreeOptions& options = {});

  /// As Structure::with_simd.
  KdTree with_simd(Simd simd) const { return KdTree(Structure::with_simd(simd)); }

 private:
  explicit KdTree(Structure structure) : Structure(std::move(structure)) {}
};

}  // namespace plumb
