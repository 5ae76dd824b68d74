#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// Stacks of layers over a lattice of cells, seen from a thousand cells above. There one float step in
// depth is 2^-14, and in each stack the layers are
//
//   equal in depth        in the plane z = 0 itself, cut along either diagonal: the least id counts;
//   equal when rounded    a quarter of a step or less apart, so that depths which differ round to the same
//   float
//                         in places, and there the id counts against the order in space;
//   a few steps apart     in any order;
//   tilted                by a few steps over the cell, so that they cross all others.
//
// The triangles' order is shuffled, so that whoever takes the first, the last or the nearest in higher
// precision is wrong in a good part of the frame.

namespace plumb::detail {
namespace {

constexpr double kStep = 0x1p-14;  // the spacing of floats from 512 to 1024
constexpr double kHeight = 1000.0;
constexpr std::uint32_t kLayers = 16;

// The layer's height at the cell's corners, in steps: a constant and slopes along x and y.
struct Layer {
  double at, slope_x, slope_y;
};

Layer layer_of(std::uint32_t cell, std::uint32_t layer) {
  const auto between = [&](double limit, std::uint32_t seed) {
    return limit * (2.0 * hash_unit(cell, layer, seed) - 1.0);
  };
  if (layer < 4) return {0.0, 0.0, 0.0};
  if (layer < 9) return {between(0.25, 1), 0.0, 0.0};
  if (layer < 12) return {between(4.0, 1), 0.0, 0.0};
  return {between(1.0, 1), between(3.0, 2), between(3.0, 3)};
}

void append_layer(TriangleMesh& mesh, double x, double y, const Layer& layer, bool other_diagonal) {
  const auto corner = [&](double u, double v) {
    return append_vertex(mesh, {x + u, y + v, kStep * (layer.at + u * layer.slope_x + v * layer.slope_y)});
  };
  const std::uint32_t a = corner(0.0, 0.0), b = corner(1.0, 0.0), c = corner(1.0, 1.0), d = corner(0.0, 1.0);
  if (other_diagonal) {
    append_quad(mesh, b, c, d, a);
  } else {
    append_quad(mesh, a, b, c, d);
  }
}

}  // namespace

BuiltinScene ties(std::size_t size) {
  const double cells = static_cast<double>(size) / (2.0 * kLayers);
  const auto rows =
      static_cast<std::uint32_t>(std::max(1.0, std::floor(std::sqrt(cells * 9.0 / 16.0) + 0.5)));
  const auto columns = static_cast<std::uint32_t>(std::max(1.0, std::floor(cells / rows + 0.5)));
  // The view is as high as the cells: the tangent of half its angle is half their number over the distance.
  // Cells stay of size 1 and the eye where it is, so that depths keep their spacing.
  const double half_tangent = 0.5 * rows / kHeight;
  BuiltinScene scene{{}, {0.0f, 0.0f, static_cast<float>(kHeight)}, {}, {0.0f, 1.0f, 0.0f}, 0.0};
  scene.fov_y_degrees = 2.0 * half_tangent * 57.29577951308232;  // its tangent is little more
  TriangleMesh& mesh = scene.mesh;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      const std::uint32_t cell = row * columns + column;
      for (std::uint32_t layer = 0; layer < kLayers; ++layer) {
        append_layer(mesh, column - 0.5 * columns, row - 0.5 * rows, layer_of(cell, layer), layer % 2 == 1);
      }
    }
  }
  // Fisher and Yates' shuffle, Durstenfeld's form.
  for (auto left = static_cast<std::uint32_t>(mesh.triangles.size()); left > 1; --left) {
    std::swap(mesh.triangles[left - 1], mesh.triangles[hash_bits(left, 0, 7) % left]);
  }
  return scene;
}

}  // namespace plumb::detail
