#include "scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "plumb/builtin.h"
#include "plumb/io.h"
#include "text.h"

namespace plumb::tool {
namespace {

constexpr std::string_view kBuiltin = "builtin:";
constexpr double kFileFovDegrees = 40.0;

bool is_finite(const glm::vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// The middle of the box around the finite triangles, where frame_all looks; the origin without one.
glm::vec3 middle_of(const TriangleMesh& mesh) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  glm::dvec3 least(kInfinity), greatest(-kInfinity);
  for (const glm::uvec3& t : mesh.triangles) {
    const glm::vec3 corners[] = {mesh.positions[t.x], mesh.positions[t.y], mesh.positions[t.z]};
    if (!std::all_of(std::begin(corners), std::end(corners), is_finite)) continue;
    for (const glm::vec3& corner : corners) {
      least = glm::min(least, glm::dvec3(corner));
      greatest = glm::max(greatest, glm::dvec3(corner));
    }
  }
  return least.x <= greatest.x ? glm::vec3((least + greatest) * 0.5) : glm::vec3(0.0f);
}

/// The options that were given, over `view`. Looking straight up or down, where y can be no "up", the
/// frame's top is -z unless --up says otherwise.
Camera look(const FrameOptions& options, BuiltinScene view, int width, int height) {
  if (options.eye) view.eye = parse_vec3("--eye", *options.eye);
  if (options.target) view.target = parse_vec3("--target", *options.target);
  if (options.up) {
    view.up = parse_vec3("--up", *options.up);
  } else if (view.eye.x == view.target.x && view.eye.z == view.target.z) {
    view.up = {0.0f, 0.0f, -1.0f};
  }
  view.fov_y_degrees = options.fov.value_or(view.fov_y_degrees);
  return view.camera(width, height);
}

Scene open_builtin(const FrameOptions& options, int width, int height) {
  BuiltinScene scene = builtin_scene(std::string_view(options.scene).substr(kBuiltin.size()));
  TriangleMesh mesh = std::move(scene.mesh);
  return {options.scene, std::move(mesh), look(options, std::move(scene), width, height)};
}

Scene open_file(const FrameOptions& options) {
  TriangleMesh mesh = load_mesh(options.scene);
  const Camera camera = file_camera(options, mesh);
  return {options.scene, std::move(mesh), camera};
}

}  // namespace

bool is_builtin(std::string_view scene) { return scene.starts_with(kBuiltin); }

void add_scene_option(CLI::App& command, std::string& scene) {
  command.add_option("SCENE", scene, "a mesh file (PLY, OBJ, STL, OFF), or builtin:NAME[:SIZE]")
      ->capture_default_str();
}

void add_threads_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads; 0 takes all that the process may use")
      ->type_name("N")
      ->capture_default_str();
}

void add_frame_options(CLI::App& command, FrameOptions& options) {
  command.add_option("--size", options.size, "the frame in pixels")->type_name("WxH")->capture_default_str();
  command.add_option("--eye", options.eye, "where the camera is")->type_name("X,Y,Z");
  command.add_option("--target", options.target, "what it looks at")->type_name("X,Y,Z");
  command.add_option("--up", options.up, "what is up in the frame")->type_name("X,Y,Z");
  command.add_option("--fov", options.fov, "the vertical field of view")->type_name("DEGREES");
  command.add_option("--simd", options.simd, "instruction set: auto (the best), a name, or all")
      ->type_name("NAME")
      ->capture_default_str();
  add_threads_option(command, options.threads);
}

Camera file_camera(const FrameOptions& options, const TriangleMesh& mesh) {
  const auto [width, height] = parse_size("--size", options.size);
  const double fov = options.fov.value_or(kFileFovDegrees);
  const Camera camera = frame_all(mesh, width, height, fov);
  if (!options.eye && !options.target && !options.up) return camera;
  return look(options, {{}, camera.eye, middle_of(mesh), {0.0f, 1.0f, 0.0f}, fov}, width, height);
}

Scene open_scene(const FrameOptions& options) {
  const auto [width, height] = parse_size("--size", options.size);
  return is_builtin(options.scene) ? open_builtin(options, width, height) : open_file(options);
}

TriangleMesh open_mesh(const std::string& scene) {
  if (!is_builtin(scene)) return load_mesh(scene);
  return builtin_scene(std::string_view(scene).substr(kBuiltin.size())).mesh;
}

std::string describe(const Scene& scene) {
  const Camera& camera = scene.camera;
  return fmt::format("{}: {} triangles, {} vertices; {}x{} pixels from ({}, {}, {})", scene.name,
                     scene.mesh.triangles.size(), scene.mesh.positions.size(), camera.width, camera.height,
                     camera.eye.x, camera.eye.y, camera.eye.z);
}

}  // namespace plumb::tool
