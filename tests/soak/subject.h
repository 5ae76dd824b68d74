#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"
#include "plumb/ray.h"

// What a soak holds against the oracle: every method on every instruction set of this build and machine.

namespace plumb::soak {

/// A structure over one mesh.
class Structure {
 public:
  virtual ~Structure() = default;
  virtual Hit closest(const Ray& ray) const = 0;
  virtual bool any(const Ray& ray) const = 0;
  virtual void all(const Ray& ray, std::vector<Hit>& hits) const = 0;
  virtual std::size_t first(const Ray& ray, std::span<Hit> hits) const = 0;
  virtual void closest(std::span<const Ray> rays, std::span<Hit> hits) const = 0;
  virtual void any(std::span<const Ray> rays, std::span<bool> hits) const = 0;
  virtual void cast(const Camera& camera, Frame& frame) const = 0;
};

struct Subject {
  std::string name;  ///< such as "bvh8 avx2"
  /// C++ that makes it of `mesh`, or for a drawer that fills `frame` through `camera`: for a test to paste.
  std::string code;
  std::function<std::unique_ptr<Structure>(const TriangleMesh& mesh)> build;  ///< null for a drawer
  std::function<void(const TriangleMesh& mesh, const Camera& camera, Frame& frame)> draw;  ///< or this is
};

/// Those of this machine; `threads` is for the drawers.
std::vector<Subject> all_subjects();

}  // namespace plumb::soak
