#include <cstdint>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// Layers of two triangles, each a little tilted and wider than any view of it, from far to near: every pixel
// is covered as often as there are layers, and whoever draws them in order draws all of them. No two meet
// within a view of four to one.

namespace plumb::detail {
namespace {

constexpr double kNearest = 1.0, kFarthest = 3.0;

}  // namespace

BuiltinScene quads(std::size_t size) {
  BuiltinScene scene{{}, {0.0f, 0.0f, 0.0f}, {0.0f, 0.0f, -1.0f}, {0.0f, 1.0f, 0.0f}, 40.0};
  const double spacing = (kFarthest - kNearest) / static_cast<double>(size);
  // At most this far from the axis is seen of a layer in a frame four times as wide as high, with room to
  // spare.
  const double half_width = 2.0 * kFarthest, half_height = 0.5 * kFarthest;
  for (std::uint32_t i = 0; i < size; ++i) {
    const double distance = kFarthest - spacing * i;
    // Each corner is off by less than half a spacing, so that the layers stay apart.
    const double tilt_x = 0.2 * spacing * (2.0 * hash_unit(i, 0, 1) - 1.0);
    const double tilt_y = 0.2 * spacing * (2.0 * hash_unit(i, 0, 2) - 1.0);
    const auto corner = [&](double x, double y) {
      return glm::dvec3(x * half_width, y * half_height, -distance + x * tilt_x + y * tilt_y);
    };
    append_quad(scene.mesh, corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0));
  }
  return scene;
}

}  // namespace plumb::detail
