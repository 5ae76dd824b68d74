#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "plumb/camera.h"
#include "plumb/mesh.h"

namespace plumb {

/// A scene made by the program and a view of it. The same bits on every machine.
struct BuiltinScene {
  TriangleMesh mesh;
  glm::vec3 eye, target, up;
  double fov_y_degrees;

  Camera camera(int width, int height) const {
    return Camera::look_at(eye, target, up, fov_y_degrees, width, height);
  }
};

/// What `builtin_scene` can make.
struct BuiltinInfo {
  std::string name;
  std::string description;   ///< one line
  std::size_t default_size;  ///< what SIZE is when it is not given
  std::string size_meaning;  ///< what SIZE counts
};
std::vector<BuiltinInfo> builtin_scenes();

/// Makes a scene from "NAME" or "NAME:SIZE". Throws plumb::Error for an unknown name (listing the
/// known ones) and a size that is no number or out of range.
BuiltinScene builtin_scene(std::string_view name_and_size);

/// A view that frames the mesh's finite triangles from the front and above, for scenes that bring
/// no camera of their own.
Camera frame_all(MeshView mesh, int width, int height, double fov_y_degrees = 40.0);

}  // namespace plumb
