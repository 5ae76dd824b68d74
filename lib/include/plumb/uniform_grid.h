#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// How a UniformGrid is built and queried.
struct UniformGridOptions {
  /// Cells for each triangle, about; from 0.001 to 1000. The grid has fewer where triangles would be
  /// listed in too many cells, and at least one.
  double cells_per_triangle = 1.0;
  /// Threads for the build; 0 takes all that the affinity mask allows. The grid does not depend on it.
  int threads = 0;
  /// Instruction set of the queries; must be Auto or one of simd_targets().
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene. All ids must be
  /// below kNone.
  std::uint32_t first_id = 0;
  /// As BuildOptions::progress.
  std::function<bool(double)> progress = nullptr;
};

/// A uniform grid: the scene's box in cells of equal size, as cubic as may be, each with a list of the
/// triangles in it (Fujimoto, Tanaka and Iwata 1986, "ARTS: Accelerated Ray-Tracing System").
///
/// The fastest of all to build, in time proportional to the triangles, and quick for rays where these lie
/// about evenly. Where they do not - a teapot in a stadium - most of them share a few cells.
class UniformGrid : public Structure {
 public:
  /// Copies what it needs of the mesh. Triangles with a NaN or infinite coordinate are left out, and counted
  /// in statistics(). Throws plumb::Error for a vertex index out of range, ids that reach kNone, 2^31
  /// triangles and more, and options out of range, and Cancelled when the options' progress says so.
  explicit UniformGrid(MeshView mesh, const UniformGridOptions& options = {});

  /// As Structure::with_simd.
  UniformGrid with_simd(Simd simd) const { return UniformGrid(Structure::with_simd(simd)); }

 private:
  explicit UniformGrid(Structure structure) : Structure(std::move(structure)) {}
};

}  // namespace plumb
