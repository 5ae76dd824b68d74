#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/camera.h"
#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb::same_bits {

/// A scene and what looks at it.
struct Part {
  TriangleMesh mesh;
  std::vector<Ray> rays;
  std::vector<Camera> cameras;
};

/// What one line of the table (table.h) is about.
struct Entry {
  std::string name;
  std::vector<Part> parts;
};

/// The built-in scenes at small sizes, then every kind of hard scene, then every hard case: made once, and
/// the same on every machine. The first call needs the default floating-point mode.
const std::vector<Entry>& entries();

/// A hash of the entry itself, to tell a scene that changed from an answer that did.
std::uint64_t hash_of_inputs(const Entry& entry);

}  // namespace plumb::same_bits
