#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <CLI/CLI.hpp>

#include "plumb/camera.h"
#include "plumb/mesh.h"

namespace plumb::tool {

inline constexpr const char* kDefaultScene = "builtin:teapot-in-stadium";

/// What every subcommand that makes frames takes.
struct FrameOptions {
  std::string scene = kDefaultScene;
  std::string size = "1280x720";
  std::optional<std::string> eye, target, up;
  std::optional<double> fov;
  std::string simd = "auto";
  int threads = 0;
};

/// Adds SCENE to a subcommand.
void add_scene_option(CLI::App& command, std::string& scene);

/// Adds --threads to a subcommand.
void add_threads_option(CLI::App& command, int& threads);

/// Adds them but SCENE to a subcommand; they are filled when the command line is parsed.
void add_frame_options(CLI::App& command, FrameOptions& options);

/// A mesh and the camera that looks at it.
struct Scene {
  std::string name;
  TriangleMesh mesh;
  Camera camera;
};

/// Reads or makes the scene. A camera option that is not given is the built-in scene's own; a file's
/// is that of frame_all, which looks at the middle of the finite triangles. Throws plumb::Error.
Scene open_scene(const FrameOptions& options);

/// Whether a SCENE is none of a file.
bool is_builtin(std::string_view scene);

/// The camera of a mesh file, of whose mesh only the box around the finite triangles matters.
Camera file_camera(const FrameOptions& options, const TriangleMesh& mesh);

/// Only the mesh of a SCENE.
TriangleMesh open_mesh(const std::string& scene);

/// One line about the scene and its camera.
std::string describe(const Scene& scene);

}  // namespace plumb::tool
