#pragma once

#include <cstdint>

#include "plumb/mesh.h"
#include "plumb/structure.h"

namespace plumb {

/// Every ray against every triangle, in plain scalar code: the reference that the trees are compared
/// with, and the honest baseline for a handful of triangles.
class BruteForce : public Structure {
 public:
  /// Copies the triangles; `first_id` is the id of the first, where the mesh is a part of a larger
  /// scene. Throws plumb::Error for a vertex index out of range and for ids that reach kNone.
  explicit BruteForce(MeshView mesh, std::uint32_t first_id = 0);
};

}  // namespace plumb
