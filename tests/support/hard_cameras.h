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

}  // namespace plumb::hard
