#pragma once

#include <cstdint>

#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// How a BruteForce is made.
struct BruteForceOptions {
  /// Instruction set of the queries; must be Auto or one of simd_targets().
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene. All ids must be
  /// below kNone.
  std::uint32_t first_id = 0;
};

/// Every ray against every triangle, in blocks of eight by SIMD: the honest baseline, and the fastest way for
/// a handful of triangles.
class BruteForce : public Structure {
 public:
  /// Copies the triangles, in the mesh's order. Triangles with a NaN or infinite coordinate are left out, and
  /// counted in statistics(). Throws plumb::Error for a vertex index out of range, for ids that reach kNone
  /// and for options out of range.
  BruteForce(MeshView mesh, const BruteForceOptions& options);
  /// The same, with ids from `first_id` on.
  explicit BruteForce(MeshView mesh, std::uint32_t first_id = 0);
};

}  // namespace plumb
