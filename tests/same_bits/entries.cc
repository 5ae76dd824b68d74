#include "same_bits/entries.h"

#include <cstddef>
#include <span>
#include <string_view>
#include <utility>

#include "cases/cases.h"
#include "plumb/builtin.h"
#include "support/hard_cameras.h"
#include "support/hard_rays.h"
#include "support/hard_scenes.h"
#include "support/hash.h"

namespace plumb::same_bits {
namespace {

constexpr std::string_view kRayKinds[] = {"at_vertex",         "at_edge",   "at_inside",
                                          "along_edge",        "in_plane",  "from_surface",
                                          "from_near_surface", "from_afar", "axis_parallel"};

// The scene's own view of it, and rays at its vertices, edges and faces.
Entry builtin_entry(const char* name, int width, int height) {
  BuiltinScene scene = builtin_scene(name);
  Part part{std::move(scene.mesh), {}, {}};
  part.cameras.push_back(
      Camera::look_at(scene.eye, scene.target, scene.up, scene.fov_y_degrees, width, height));
  hard::Random random(1);
  for (const std::string_view kind : kRayKinds) {
    for (int i = 0; i < 8; ++i) part.rays.push_back(hard::ray_of_kind(random, part.mesh, kind));
  }
  return {name, {std::move(part)}};
}

// Every kind of camera looks at one of four scenes.
Entry hard_entry(const hard::SceneKind& kind) {
  constexpr std::size_t kScenes = 4;
  Entry entry{"hard " + std::string(kind.name), {}};
  const std::span<const hard::CameraKind> cameras = hard::camera_kinds();
  for (std::size_t i = 0; i < kScenes; ++i) {
    const std::uint64_t seed = i + 1;
    hard::Case hard_case = hard::make_case(kind, seed, 48);
    Part part{std::move(hard_case.mesh), std::move(hard_case.rays), {}};
    hard::Random random(seed);
    for (std::size_t k = i; k < cameras.size(); k += kScenes)
      part.cameras.push_back(cameras[k].make(random, part.mesh));
    entry.parts.push_back(std::move(part));
  }
  return entry;
}

Entry case_entry(const cases::Case& hard_case) {
  Entry entry{"case " + std::string(hard_case.name), {}};
  const std::uint64_t count = hard_case.cost > 1 ? 1 : 2;
  for (std::uint64_t i = 0; i < count; ++i) {
    cases::Instance instance = cases::make_instance(hard_case, 1, i);
    Part part{std::move(instance.mesh), std::move(instance.rays), {}};
    if (instance.camera) part.cameras.push_back(*instance.camera);
    entry.parts.push_back(std::move(part));
  }
  return entry;
}

std::vector<Entry> make_entries() {
  std::vector<Entry> result;
  result.push_back(builtin_entry("teapot-in-stadium:3000", 80, 45));
  result.push_back(builtin_entry("terrain:2000", 80, 45));
  result.push_back(builtin_entry("grid:12", 16, 256));  // of 256 lines, many pass through its vertices
  result.push_back(builtin_entry("grass:2000", 80, 45));
  result.push_back(builtin_entry("soup:2000", 80, 45));
  result.push_back(builtin_entry("spheres:2000", 80, 45));
  result.push_back(builtin_entry("quads:24", 80, 45));
  result.push_back(builtin_entry("cornell:500", 80, 45));
  result.push_back(builtin_entry("ties:1000", 80, 45));
  for (const hard::SceneKind& kind : hard::scene_kinds()) result.push_back(hard_entry(kind));
  for (const cases::Case& hard_case : cases::all_cases()) result.push_back(case_entry(hard_case));
  return result;
}

void add(hard::Hash& hash, const Part& part) {
  for (const glm::vec3& position : part.mesh.positions) hash.add(position);
  for (const glm::uvec3& triangle : part.mesh.triangles) hash.add(triangle);
  for (const Ray& ray : part.rays) {
    hash.add(ray.origin);
    hash.add(ray.tmin);
    hash.add(ray.direction);
    hash.add(ray.tmax);
  }
  for (const Camera& camera : part.cameras) {
    hash.add(camera.eye);
    for (const glm::dvec3& v : {camera.corner, camera.du, camera.dv}) hash.add(v);
    hash.add(static_cast<std::uint32_t>(camera.width));
    hash.add(static_cast<std::uint32_t>(camera.height));
  }
}

}  // namespace

const std::vector<Entry>& entries() {
  static const std::vector<Entry> made = make_entries();
  return made;
}

std::uint64_t hash_of_inputs(const Entry& entry) {
  hard::Hash hash;
  for (const Part& part : entry.parts) add(hash, part);
  return hash.value();
}

}  // namespace plumb::same_bits
