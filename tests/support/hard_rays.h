#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "plumb/mesh.h"
#include "plumb/ray.h"
#include "support/hard_scenes.h"

namespace plumb::hard {

/// A small scene and rays at its vertices, edges, planes and ends of range. Made from its kind and seed
/// alone, the same on every machine.
struct Case {
  std::string_view scene;
  std::uint64_t seed;
  TriangleMesh mesh;
  std::vector<Ray> rays;
  std::vector<std::string_view> ray_kinds;  ///< how each ray was made

  /// For messages of tests: enough to make the case again, and ray i itself.
  std::string describe(std::size_t i) const;
};

Case make_case(const SceneKind& scene, std::uint64_t seed, std::size_t ray_count);

/// A ray of one kind ("at_vertex", "along_edge", ...) at the mesh, with nothing else done to it. Throws
/// std::invalid_argument for a kind that is none.
Ray ray_of_kind(Random& random, const TriangleMesh& mesh, std::string_view kind);

/// `seeds` cases of every kind of scene, in one list.
std::vector<Case> make_cases(std::uint64_t seeds, std::size_t ray_count);

}  // namespace plumb::hard
