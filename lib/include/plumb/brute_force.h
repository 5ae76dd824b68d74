#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb {

/// Every ray against every triangle, in plain scalar code: the reference that the trees are compared
/// with, and the honest baseline for a handful of triangles.
///
/// Answers what Bvh does, bit for bit. Immutable: const calls from many threads are safe, and copies
/// share the triangles. One that was moved from can only be assigned to.
class BruteForce {
 public:
  /// Copies the triangles; `first_id` is the id of the first, where the mesh is a part of a larger
  /// scene. Throws plumb::Error for a vertex index out of range and for ids that reach kNone.
  explicit BruteForce(MeshView mesh, std::uint32_t first_id = 0);

  /// As Bvh::closest.
  Hit closest(const Ray& ray) const;
  /// As Bvh::any.
  bool any(const Ray& ray) const;
  /// As Bvh::all.
  void all(const Ray& ray, std::vector<Hit>& hits) const;
  /// As Bvh::closest for many rays.
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// As Bvh::any for many rays.
  void any(std::span<const Ray> rays, std::span<bool> hits) const;

  struct Impl;

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace plumb
