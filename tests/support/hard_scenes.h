#pragma once

#include <span>
#include <string_view>

#include "plumb/mesh.h"
#include "support/random.h"

namespace plumb::hard {

/// A way to make small scenes that are hard to answer exactly.
struct SceneKind {
  std::string_view name;
  TriangleMesh (*make)(Random&);
};

std::span<const SceneKind> scene_kinds();

/// `f` moved by some floats, at most `limit` up or down; stays finite.
float nudged(Random& random, float f, int limit);
glm::vec3 nudged(Random& random, glm::vec3 v, int limit);

}  // namespace plumb::hard
