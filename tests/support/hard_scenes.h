#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
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

/// A scene of one kind. Throws std::invalid_argument for a kind that is none.
TriangleMesh scene_of_kind(Random& random, std::string_view kind);

/// The one of `kinds` with that name. Throws std::invalid_argument where there is none.
template <typename Kinds>
const auto& kind_called(const Kinds& kinds, std::string_view name) {
  const auto found =
      std::find_if(std::begin(kinds), std::end(kinds), [&](const auto& kind) { return kind.name == name; });
  if (found == std::end(kinds)) throw std::invalid_argument("there is no kind " + std::string(name));
  return *found;
}

/// `f` moved by some floats, at most `limit` up or down; stays finite.
float nudged(Random& random, float f, int limit);
glm::vec3 nudged(Random& random, glm::vec3 v, int limit);

}  // namespace plumb::hard
