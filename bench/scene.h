#pragma once

#include <string>
#include <vector>

#include "plumb/camera.h"
#include "plumb/mesh.h"

namespace plumb::bench {

/// A scene and the place it is seen from, by their names; nothing is loaded yet.
struct ViewName {
  std::string scene;    ///< builtin:NAME[:SIZE], or a mesh file
  std::string view;     ///< a name from `cameras`; empty: the scene's own camera, or one that frames the mesh
  std::string cameras;  ///< the file that lists the view

  /// What to call it in a table: the file's stem or the built-in name, and the view.
  std::string title() const;
};

/// The views that a command-line argument names: builtin:NAME[:SIZE], FILE or FILE@VIEW. Where `cameras`
/// names a list of cameras, FILE stands for all views of it that it lists. A line of the list is
///     scene view eye(3) target(3) up(3) fov_y_degrees
/// with the scene called by its file's stem. Throws plumb::Error for a list that does not parse and a
/// view that it lacks.
std::vector<ViewName> views_of(const std::string& argument, const std::string& cameras);

/// A loaded scene and its camera.
struct View {
  TriangleMesh mesh;
  Camera camera;
};

/// Loads or makes it. Throws plumb::Error as `load_mesh`, `builtin_scene` and `Camera::look_at` do.
View load_view(const ViewName& name, int width, int height);

}  // namespace plumb::bench
