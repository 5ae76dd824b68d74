#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// Blades of five triangles on a flat ground, as many to the square metre whatever the size: the field
// grows. Long thin triangles in all directions, whose boxes overlap: hard on hierarchies of boxes, and most
// of them hide behind others.

namespace plumb::detail {
namespace {

constexpr double kSpacing = 0.022;  // metres between blades

double hash_between(double low, double high, std::uint32_t blade, std::uint32_t seed) {
  return low + (high - low) * hash_unit(blade, 0, seed);
}

// A blade from `root` on: it narrows as it rises and bends over towards where it leans.
void append_blade(TriangleMesh& mesh, const glm::dvec3& root, std::uint32_t blade) {
  const Turn heading = turn(hash_unit(blade, 0, 1));
  const Turn lean = turn(hash_unit(blade, 0, 2));
  const double tall = hash_between(0.10, 0.32, blade, 3);
  const double bend = tall * hash_between(0.1, 0.7, blade, 4);
  const double half_width = hash_between(0.0015, 0.0035, blade, 5);
  const auto side = [&](double along, double width) {
    const double droop = 1.0 - 0.25 * along;
    return root + glm::dvec3(heading.cos * width + lean.cos * bend * along * along, tall * along * droop,
                             heading.sin * width + lean.sin * bend * along * along);
  };
  constexpr double kLevels[] = {0.0, 0.4, 0.75};
  constexpr double kWidths[] = {1.0, 0.8, 0.5};
  std::uint32_t below = 0;
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t left = append_vertex(mesh, side(kLevels[i], -half_width * kWidths[i]));
    append_vertex(mesh, side(kLevels[i], half_width * kWidths[i]));
    if (i > 0) append_quad(mesh, below, below + 1, left + 1, left);
    below = left;
  }
  const std::uint32_t tip = append_vertex(mesh, side(1.0, 0.0));
  mesh.triangles.emplace_back(below, below + 1, tip);
}

}  // namespace

BuiltinScene grass(std::size_t size) {
  const double blades = std::max(1.0, static_cast<double>(size - 2) / 5.0);
  const auto rows = static_cast<std::uint32_t>(std::max(1.0, std::floor(std::sqrt(blades) + 0.5)));
  const double half = 0.5 * kSpacing * rows;
  BuiltinScene scene{{}, {}, {}, {0.0f, 1.0f, 0.0f}, 45.0};
  TriangleMesh& mesh = scene.mesh;
  mesh.positions.reserve(4 + 7 * std::size_t{rows} * rows);
  mesh.triangles.reserve(2 + 5 * std::size_t{rows} * rows);
  append_quad(mesh, {-half, 0.0, -half}, {-half, 0.0, half}, {half, 0.0, half}, {half, 0.0, -half});
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < rows; ++column) {
      const std::uint32_t blade = row * rows + column;
      const double x = (column + hash_unit(blade, 0, 6)) * kSpacing - half;
      const double z = (row + hash_unit(blade, 0, 7)) * kSpacing - half;
      append_blade(mesh, {x, 0.0, z}, blade);
    }
  }
  scene.eye = to_vertex({0.0, 0.45 + 0.1 * half, 1.1 * half});
  scene.target = to_vertex({0.0, 0.0, 0.35 * half});
  return scene;
}

}  // namespace plumb::detail
