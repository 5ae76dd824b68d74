#pragma once

#include <span>
#include <string_view>

#include "plumb/camera.h"
#include "plumb/mesh.h"
#include "support/random.h"

namespace plumb::hard {

/// A way to look at a scene that is hard to answer exactly.
struct CameraKind {
  std::string_view name;
  Camera (*make)(Random&, const TriangleMesh&);
};

std::span<const CameraKind> camera_kinds();

/// A camera of one kind at the mesh. Throws std::invalid_argument for a kind that is none.
Camera camera_of_kind(Random& random, const TriangleMesh& mesh, std::string_view kind);

}  // namespace plumb::hard
