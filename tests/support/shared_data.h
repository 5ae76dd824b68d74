#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "plumb/frame.h"
#include "plumb/mesh.h"
#include "plumb/ray.h"

// The scenes and exact answers that lie beside the project in ../shared, where they are there. Reads
// just those formats and nothing else, apart from plumb::io. Whatever is not as expected throws
// std::runtime_error.

namespace plumb::shared {

/// Whether the data is there. Tests that need it say so when it is not: see PLUMB_REQUIRE_SHARED.
bool available();

/// What to print when it is not.
std::string missing_message();

/// A line of cameras.txt.
struct View {
  std::string scene, name;
  glm::vec3 eye, target, up;
  double fov_y_degrees;
};

/// The size of every frame.
inline constexpr int kFrameWidth = 320;
inline constexpr int kFrameHeight = 180;

std::vector<View> views();

/// Those of one scene.
std::vector<View> views_of(const std::string& scene);

/// The names of the scenes, each once, in the order of cameras.txt.
std::vector<std::string> scenes();

/// The file of a scene.
std::filesystem::path scene_file(const std::string& scene);

/// Binary little-endian PLY of `float x y z` and `list uchar int vertex_indices`, all triangles.
TriangleMesh load_scene(const std::string& scene);

/// What scenes/README.md says of a scene, found by other programs. A cell without a number is empty.
struct SceneFacts {
  std::string name;
  std::optional<std::size_t> triangles, vertices, repeated_index, collapsed, degenerate, duplicates,
      open_edges,
      edges_of_many;  ///< of more than two triangles; edges and collapsed triangles are told by position
};
std::vector<SceneFacts> scene_facts();

/// The hard rays of a scene and their closest hits, one for each.
std::vector<Ray> rays(const std::string& scene);
std::vector<Hit> hits(const std::string& scene);

/// What a view sees.
Frame frame(const View& view);

}  // namespace plumb::shared

/// Ends the test case, visibly, where the data is not there.
#define PLUMB_REQUIRE_SHARED()                     \
  do {                                             \
    if (!::plumb::shared::available()) {           \
      MESSAGE(::plumb::shared::missing_message()); \
      return;                                      \
    }                                              \
  } while (false)
