#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// The Cornell box, in millimetres, as measured by the Program of Computer Graphics, Cornell University
// ("Cornell Box Data", 1998; first in Goral, Torrance, Greenberg and Battaile, SIGGRAPH 1984). The lamp lies
// in the plane of the ceiling, which has no hole for it: both are seen at equal depths, and the lower id
// counts.

namespace plumb::detail {
namespace {

using Quad = std::array<std::array<double, 3>, 4>;

constexpr Quad kQuads[] = {
    {{{343.0, 548.8, 227.0}, {343.0, 548.8, 332.0}, {213.0, 548.8, 332.0}, {213.0, 548.8, 227.0}}},  // lamp
    {{{552.8, 0.0, 0.0}, {0.0, 0.0, 0.0}, {0.0, 0.0, 559.2}, {549.6, 0.0, 559.2}}},                  // floor
    {{{556.0, 548.8, 0.0}, {556.0, 548.8, 559.2}, {0.0, 548.8, 559.2}, {0.0, 548.8, 0.0}}},  // ceiling
    {{{549.6, 0.0, 559.2}, {0.0, 0.0, 559.2}, {0.0, 548.8, 559.2}, {556.0, 548.8, 559.2}}},  // back
    {{{0.0, 0.0, 559.2}, {0.0, 0.0, 0.0}, {0.0, 548.8, 0.0}, {0.0, 548.8, 559.2}}},          // right
    {{{552.8, 0.0, 0.0}, {549.6, 0.0, 559.2}, {556.0, 548.8, 559.2}, {556.0, 548.8, 0.0}}},  // left
    // The short block.
    {{{130.0, 165.0, 65.0}, {82.0, 165.0, 225.0}, {240.0, 165.0, 272.0}, {290.0, 165.0, 114.0}}},
    {{{290.0, 0.0, 114.0}, {290.0, 165.0, 114.0}, {240.0, 165.0, 272.0}, {240.0, 0.0, 272.0}}},
    {{{130.0, 0.0, 65.0}, {130.0, 165.0, 65.0}, {290.0, 165.0, 114.0}, {290.0, 0.0, 114.0}}},
    {{{82.0, 0.0, 225.0}, {82.0, 165.0, 225.0}, {130.0, 165.0, 65.0}, {130.0, 0.0, 65.0}}},
    {{{240.0, 0.0, 272.0}, {240.0, 165.0, 272.0}, {82.0, 165.0, 225.0}, {82.0, 0.0, 225.0}}},
    // The tall one.
    {{{423.0, 330.0, 247.0}, {265.0, 330.0, 296.0}, {314.0, 330.0, 456.0}, {472.0, 330.0, 406.0}}},
    {{{423.0, 0.0, 247.0}, {423.0, 330.0, 247.0}, {472.0, 330.0, 406.0}, {472.0, 0.0, 406.0}}},
    {{{472.0, 0.0, 406.0}, {472.0, 330.0, 406.0}, {314.0, 330.0, 456.0}, {314.0, 0.0, 456.0}}},
    {{{314.0, 0.0, 456.0}, {314.0, 330.0, 456.0}, {265.0, 330.0, 296.0}, {265.0, 0.0, 296.0}}},
    {{{265.0, 0.0, 296.0}, {265.0, 330.0, 296.0}, {423.0, 330.0, 247.0}, {423.0, 0.0, 247.0}}},
};
constexpr std::size_t kQuadCount = std::size(kQuads);
// 2 atan(0.025 / 2 / 0.035): the film's size and the lens's focal length.
constexpr double kFovDegrees = 39.307641498;

glm::dvec3 point(const Quad& quad, double u, double v) {
  const auto corner = [&](std::size_t i) { return glm::dvec3(quad[i][0], quad[i][1], quad[i][2]); };
  return (corner(0) * (1.0 - u) + corner(1) * u) * (1.0 - v) + (corner(3) * (1.0 - u) + corner(2) * u) * v;
}

}  // namespace

BuiltinScene cornell(std::size_t size) {
  const auto n = static_cast<std::uint32_t>(
      std::max(1.0, std::floor(std::sqrt(static_cast<double>(size) / (2.0 * kQuadCount)) + 0.5)));
  BuiltinScene scene{{}, {278.0f, 273.0f, -800.0f}, {278.0f, 273.0f, 0.0f}, {0.0f, 1.0f, 0.0f}, kFovDegrees};
  TriangleMesh& mesh = scene.mesh;
  for (const Quad& quad : kQuads) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (std::uint32_t row = 0; row <= n; ++row) {
      for (std::uint32_t column = 0; column <= n; ++column) {
        append_vertex(mesh, point(quad, static_cast<double>(column) / n, static_cast<double>(row) / n));
      }
    }
    for (std::uint32_t row = 0; row < n; ++row) {
      for (std::uint32_t column = 0; column < n; ++column) {
        const std::uint32_t a = first + row * (n + 1) + column;
        append_quad(mesh, a, a + 1, a + n + 2, a + n + 1);
      }
    }
  }
  return scene;
}

}  // namespace plumb::detail
