#include <algorithm>
#include <cstdint>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// A relief of square blocks on integer coordinates, seen so that pixel rays meet vertices, edges and
// diagonals exactly, by the thousand: what a filter in floating point can never settle.
//
// The camera looks straight down -z, and half its field of view has the tangent 135/256. So in a
// frame of W x H pixels the direction of pixel (x, y) is
//
//     (135 (2x + 1 - W) / (256 H), 135 (H - 1 - 2y) / (256 H), -1)
//
// exactly, where 135 / H is a dyadic fraction: for H = 720, 1080, 512 and their halves and doubles, for
// example. The eye is 9 * 2^17 above the plane z = 0; k * 2^17 below the eye, the ray of a pixel is at
//
//     x = k p a,  y = k p b  with odd a and b,  p = 2^17 * 135 / (256 H): 96 for H = 720, 135 for H = 512
//
// The blocks of the upper half (y > 0) have sides of 63 * 96, those of the lower half 63 * 135, and
// every top is at k = 9, 7 or 6. So with H = 720 and in the upper half, a ray meets lines of the
// lattice at k = 9 in every 7th column and every 7th row, at k = 7 in every 9th, at k = 6 in every
// 21st, and the blocks' diagonals as often; with H = 512 the same holds in the lower half. Halving H
// changes nothing of it; with H = 1080 a third as many do it in the upper half. Of all pixels of a
// 1280 x 720 frame of the default size, 9.9 % see a triangle exactly on its edge or vertex; of a
// 512 x 512 frame 14.8 %.

namespace plumb::detail {
namespace {

constexpr double kLevel = 131072.0;              // 2^17
constexpr double kFovDegrees = 55.609285526465;  // 2 atan(135 / 256)
constexpr std::int64_t kUpperSide = 63 * 96;
constexpr std::int64_t kLowerSide = 63 * 135;

// The cells (i, j) of one half: x from i * side, |y| from j * side.
struct Half {
  std::int64_t side;
  std::int64_t sign;  // of y
  std::int64_t first_column, columns, rows;

  // How far the top is below the eye, in units of kLevel. Towns of 24 x 24 blocks share a level, but in
  // some each block has its own.
  int level(std::int64_t i, std::int64_t j) const {
    if (i < first_column || i >= first_column + columns || j < 0 || j >= rows) return 9;
    const std::uint32_t x = static_cast<std::uint32_t>(i + 65536), y = static_cast<std::uint32_t>(j);
    const std::uint32_t seed = sign > 0 ? 1u : 2u;
    const std::uint32_t town = hash_bits(x / 24, y / 24, seed) % 16;
    if (town < 2) return hash_bits(x, y, seed + 2) % 4 == 0 ? 7 : 9;
    return town < 4 ? 6 : town < 8 ? 7 : 9;
  }

  glm::dvec3 point(std::int64_t i, std::int64_t j, int at_level) const {
    return {static_cast<double>(i * side), static_cast<double>(sign * j * side), (9 - at_level) * kLevel};
  }
};

void append_half(TriangleMesh& mesh, const Half& half) {
  for (std::int64_t j = 0; j < half.rows; ++j) {
    for (std::int64_t i = half.first_column; i < half.first_column + half.columns; ++i) {
      const int here = half.level(i, j);
      append_quad(mesh, half.point(i, j, here), half.point(i + 1, j, here), half.point(i + 1, j + 1, here),
                  half.point(i, j + 1, here));
    }
  }
  // Walls between cells of different levels, and around the half down to the ground.
  const auto wall = [&](std::int64_t i0, std::int64_t j0, std::int64_t i1, std::int64_t j1, int a, int b) {
    if (a == b) return;
    append_quad(mesh, half.point(i0, j0, a), half.point(i1, j1, a), half.point(i1, j1, b),
                half.point(i0, j0, b));
  };
  for (std::int64_t j = 0; j <= half.rows; ++j) {
    for (std::int64_t i = half.first_column; i <= half.first_column + half.columns; ++i) {
      const int here = half.level(i, j);
      wall(i, j, i, j + 1, half.level(i - 1, j), here);
      wall(i, j, i + 1, j, half.level(i, j - 1), here);
    }
  }
}

}  // namespace

BuiltinScene grid(std::size_t size) {
  // 16 to 9, as frames are: the upper half has size x size * 9/32 blocks.
  const std::int64_t columns = static_cast<std::int64_t>(size);
  const std::int64_t rows = std::max<std::int64_t>(1, columns * 9 / 32);
  const std::int64_t lower_columns = std::max<std::int64_t>(1, columns * kUpperSide / kLowerSide);
  const std::int64_t lower_rows = std::max<std::int64_t>(1, rows * kUpperSide / kLowerSide);
  BuiltinScene scene{{}, {0.0f, 0.0f, static_cast<float>(9.0 * kLevel)}, {}, {0.0f, 1.0f, 0.0f}, kFovDegrees};
  append_half(scene.mesh, {kUpperSide, 1, -(columns / 2), columns, rows});
  append_half(scene.mesh, {kLowerSide, -1, -(lower_columns / 2), lower_columns, lower_rows});
  return scene;
}

}  // namespace plumb::detail
