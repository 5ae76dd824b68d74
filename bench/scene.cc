#include "scene.h"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

#include "plumb/builtin.h"
#include "plumb/error.h"
#ifdef PLUMB_BENCH_FILES
#include "plumb/io.h"
#endif

namespace plumb::bench {
namespace {

constexpr std::string_view kBuiltin = "builtin:";

bool is_builtin(const std::string& scene) { return scene.rfind(kBuiltin, 0) == 0; }

std::string stem(const std::string& scene) {
  return is_builtin(scene) ? scene.substr(kBuiltin.size()) : std::filesystem::path(scene).stem().string();
}

struct CameraLine {
  std::string scene, view;
  glm::vec3 eye, target, up;
  double fov_y_degrees = 0;
};

std::vector<CameraLine> read_cameras(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error("plumb_bench: cannot read the camera list '" + path + "'");
  std::vector<CameraLine> cameras;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    if (text.empty() || text[0] == '#') continue;
    CameraLine line;
    std::istringstream words(text);
    words >> line.scene >> line.view;
    for (glm::vec3* v : {&line.eye, &line.target, &line.up}) words >> v->x >> v->y >> v->z;
    words >> line.fov_y_degrees;
    if (!words) {
      throw Error(path + ":" + std::to_string(number) +
                  ": expected a scene, a view, eye, target and up (3 numbers each) and the field of view");
    }
    cameras.push_back(line);
  }
  return cameras;
}

TriangleMesh load_file(const std::string& path) {
#ifdef PLUMB_BENCH_FILES
  return load_mesh(path);
#else
  throw Error("plumb_bench: '" + path + "': built without plumb::io, so only builtin:NAME can be timed");
#endif
}

Camera listed_camera(const ViewName& name, int width, int height) {
  for (const CameraLine& line : read_cameras(name.cameras)) {
    if (line.scene == stem(name.scene) && line.view == name.view) {
      return Camera::look_at(line.eye, line.target, line.up, line.fov_y_degrees, width, height);
    }
  }
  throw Error("plumb_bench: '" + name.cameras + "' lists no view '" + name.view + "' of '" +
              stem(name.scene) + "'");
}

}  // namespace

std::string ViewName::title() const { return view.empty() ? stem(scene) : stem(scene) + ", " + view; }

std::vector<ViewName> views_of(const std::string& argument, const std::string& cameras) {
  if (is_builtin(argument)) return {{argument, "", ""}};
  const std::size_t at = argument.rfind('@');
  if (at != std::string::npos) return {{argument.substr(0, at), argument.substr(at + 1), cameras}};
  std::vector<ViewName> views;
  if (!cameras.empty()) {
    for (const CameraLine& line : read_cameras(cameras)) {
      if (line.scene == stem(argument)) views.push_back({argument, line.view, cameras});
    }
  }
  if (views.empty()) views.push_back({argument, "", ""});
  return views;
}

View load_view(const ViewName& name, int width, int height) {
  if (is_builtin(name.scene)) {
    BuiltinScene scene = builtin_scene(name.scene.substr(kBuiltin.size()));
    const Camera camera = scene.camera(width, height);
    return {std::move(scene.mesh), camera};
  }
  TriangleMesh mesh = load_file(name.scene);
  const Camera camera =
      name.view.empty() ? frame_all(mesh, width, height) : listed_camera(name, width, height);
  return {std::move(mesh), camera};
}

}  // namespace plumb::bench
