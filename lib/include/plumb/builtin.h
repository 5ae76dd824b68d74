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
  TriangleMesh mesh;     ///< all of whose coordinates are finite
  glm::vec3 eye;         ///< where the view is from
  glm::vec3 target;      ///< what it looks at
  glm::vec3 up;          ///< which way is up
  double fov_y_degrees;  ///< vertical field of view

  /// The view as a camera of so many pixels, each at least 1; otherwise plumb::Error.
  Camera camera(int width, int height) const {
    return Camera::look_at(eye, target, up, fov_y_degrees, width, height);
  }
};

/// A kind of scene that builtin_scene() can make.
struct BuiltinInfo {
  std::string name;          ///< as in "NAME:SIZE"
  std::string description;   ///< one line
  std::size_t default_size;  ///< what SIZE is when it is not given
  std::string size_meaning;  ///< what SIZE counts, and its least and greatest value
};

/// All that builtin_scene() can make.
std::vector<BuiltinInfo> builtin_scenes();

/// Makes a scene from "NAME" or "NAME:SIZE". Throws plumb::Error for an unknown name (listing the
/// known ones) and a size that is no number or out of range.
BuiltinScene builtin_scene(std::string_view name_and_size);

/// A view that frames the mesh's finite triangles from the front (+z), above (+y) and a little to the
/// right, for scenes that bring no camera of their own; without any such triangle, the cube of +-1.
/// Throws plumb::Error for a vertex index out of range, a mesh so large that no eye with finite
/// coordinates sees all of it, and where Camera::look_at does.
Camera frame_all(MeshView mesh, int width, int height, double fov_y_degrees = 40.0);

}  // namespace plumb
