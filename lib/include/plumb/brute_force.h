#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb {

/// Every ray against every triangle, in plain scalar code: the reference that the trees are compared
/// with, and the honest baseline for a handful of triangles. Same answers as Bvh.
class BruteForce {
 public:
  /// Copies the triangles. Throws plumb::Error for an index out of range or too many triangles.
  explicit BruteForce(MeshView mesh, std::uint32_t first_id = 0);

  Hit closest(const Ray& ray) const;
  bool any(const Ray& ray) const;
  void all(const Ray& ray, std::vector<Hit>& hits) const;
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  void any(std::span<const Ray> rays, std::span<bool> hits) const;

  struct Impl;

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace plumb
