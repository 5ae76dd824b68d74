#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"
#include "scene/teapot.h"
#include "scene/track.h"

// The classic hard case for spatial data structures, a teapot in a stadium: the teapot is a thousandth
// of the stadium's length. The pitch's lines, its stripes, the running track and the ground all lie in the
// plane y = 0 exactly; where they overlap, their depths are equal and the lower id is seen, so what
// is painted last here comes first.

namespace plumb::detail {
namespace {

constexpr Track kStands{35.0, 18.0, 30.0};  // the front of the stands

int at_least(int least, double count) { return std::max(least, static_cast<int>(std::floor(count + 0.5))); }

// An axis-parallel rectangle of the ground.
void append_patch(TriangleMesh& mesh, double x0, double x1, double z0, double z1) {
  append_quad(mesh, {x0, 0.0, z0}, {x0, 0.0, z1}, {x1, 0.0, z1}, {x1, 0.0, z0});
}

// A profile swept along a track: profile points are (offset outward, height).
struct ProfilePoint {
  double offset, y;
};
void append_sweep(TriangleMesh& mesh, const Track& track, const std::vector<ProfilePoint>& profile,
                  int segments) {
  const std::uint32_t first = static_cast<std::uint32_t>(mesh.positions.size());
  const std::uint32_t row = static_cast<std::uint32_t>(profile.size());
  const std::uint32_t columns = static_cast<std::uint32_t>(segments);
  for (std::uint32_t i = 0; i < columns; ++i) {
    const TrackSpot spot = track.spot(static_cast<double>(i) / segments);
    for (const ProfilePoint& p : profile) append_vertex(mesh, spot.at(p.offset, p.y));
  }
  for (std::uint32_t i = 0; i < columns; ++i) {
    const std::uint32_t here = first + i * row;
    const std::uint32_t next = first + ((i + 1) % columns) * row;
    for (std::uint32_t j = 0; j + 1 < row; ++j) {
      append_quad(mesh, here + j, here + j + 1, next + j + 1, next + j);
    }
  }
}

void append_lines(TriangleMesh& mesh, double detail) {
  constexpr double kWidth = 0.12, kX = 52.5, kZ = 34.0;
  const auto line_z = [&](double x, double z0, double z1) {
    append_patch(mesh, x - kWidth / 2, x + kWidth / 2, z0, z1);
  };
  const auto line_x = [&](double z, double x0, double x1) {
    append_patch(mesh, x0, x1, z - kWidth / 2, z + kWidth / 2);
  };
  line_z(0.0, -kZ, kZ);
  for (const double side : {-1.0, 1.0}) {
    line_z(side * kX, -kZ, kZ);
    line_x(side * kZ, -kX, kX);
    // Penalty area and goal area.
    for (const auto& [depth, half_width] : {std::array{16.5, 20.16}, std::array{5.5, 9.16}}) {
      const double x = side * (kX - depth);
      line_z(x, -half_width, half_width);
      line_x(-half_width, std::min(x, side * kX), std::max(x, side * kX));
      line_x(half_width, std::min(x, side * kX), std::max(x, side * kX));
    }
  }
  append_sweep(mesh, {0.0, 0.0, 9.15}, {{-kWidth / 2, 0.0}, {kWidth / 2, 0.0}}, at_least(8, 96 * detail));
}

void append_ground(TriangleMesh& mesh, double detail) {
  append_lines(mesh, detail);
  const int segments = at_least(16, 192 * detail);
  for (int lane = 0; lane < 8; ++lane) {
    const double inner = -11.5 + 1.22 * lane;
    append_sweep(mesh, kStands, {{inner, 0.0}, {inner + 1.17, 0.0}}, segments);
  }
  for (int stripe = 0; stripe < 22; ++stripe) {
    const double x = -55.0 + 5.0 * stripe;
    append_patch(mesh, x, x + 5.0, -36.0, 36.0);
  }
  append_patch(mesh, -135.0, 135.0, -118.0, 118.0);
}

// A tier of steps, seats on each.
struct Tier {
  double front;   // offset of the first step's front from kStands
  double bottom;  // its height
  double depth;   // of the whole tier
  double rise;    // of the whole tier
  int rows;

  double step_depth() const { return depth / rows; }
  double step_rise() const { return rise / rows; }
};

// A seat is a sheet folded once, pan and back: a row of these on one step.
void append_seats(TriangleMesh& mesh, const Tier& tier, int row, double detail) {
  constexpr double kSectors = 56.0;     // aisles divide the stands into so many
  constexpr double kAisleShare = 0.06;  // of a sector
  const double scale = 1.0 / detail;    // of a seat
  const double y = tier.bottom + tier.step_rise() * (row + 1);
  const double back = tier.front + tier.step_depth() * (row + 0.85);
  const double front = tier.front + tier.step_depth() * (row + 0.4);
  Track track = kStands;
  track.radius += back;
  const int seats = at_least(16, track.length() / (0.58 * scale));
  for (int i = 0; i < seats; ++i) {
    const double share = (i + 0.5) / seats;
    const double in_sector = kSectors * share - std::floor(kSectors * share);
    if (in_sector < kAisleShare) continue;
    const TrackSpot spot = track.spot(share);
    // The tangent is the normal turned by a quarter.
    const double half = 0.22 * scale;
    const auto corner = [&](double side, double offset, double height) {
      const glm::dvec3 p = spot.at(offset - back, y + height * scale);
      return glm::dvec3(p.x - side * half * spot.normal_z, p.y, p.z + side * half * spot.normal_x);
    };
    const std::uint32_t first = append_vertex(mesh, corner(-1.0, front, 0.4));
    append_vertex(mesh, corner(1.0, front, 0.4));
    append_vertex(mesh, corner(1.0, back, 0.36));
    append_vertex(mesh, corner(-1.0, back, 0.36));
    append_vertex(mesh, corner(1.0, back + 0.08 * tier.step_depth(), 0.8));
    append_vertex(mesh, corner(-1.0, back + 0.08 * tier.step_depth(), 0.8));
    append_quad(mesh, first, first + 1, first + 2, first + 3);
    append_quad(mesh, first + 3, first + 2, first + 4, first + 5);
  }
}

void append_tier(TriangleMesh& mesh, const Tier& tier, int segments, double detail) {
  std::vector<ProfilePoint> steps{{tier.front, tier.bottom - 1.2}};  // a wall in front
  for (int row = 0; row < tier.rows; ++row) {
    const double y = tier.bottom + tier.step_rise() * (row + 1);
    steps.push_back({tier.front + tier.step_depth() * row, y});
    steps.push_back({tier.front + tier.step_depth() * (row + 1), y});
  }
  append_sweep(mesh, kStands, steps, segments);
  for (int row = 0; row < tier.rows; ++row) append_seats(mesh, tier, row, detail);
}

// A canopy over the upper tier, held by a wall all around.
void append_roof(TriangleMesh& mesh, int segments) {
  append_sweep(mesh, kStands,
               {{57.0, 0.0}, {57.0, 36.0}, {36.0, 40.0}, {36.0, 39.0}, {55.0, 34.0}, {55.0, 0.0}}, segments);
}

// A round column with a foot and a plate.
void append_plinth(TriangleMesh& mesh, double detail) {
  constexpr double kRadius = 0.3;
  std::vector<ProfilePoint> profile;
  for (const auto& [radius, y] :
       {std::array{kRadius, 0.0}, std::array{kRadius, 0.12}, std::array{0.18, 0.16}, std::array{0.15, 1.0},
        std::array{0.22, 1.05}, std::array{0.22, kPlinthHeight}, std::array{0.0, kPlinthHeight}}) {
    profile.push_back({radius - kRadius, y});
  }
  append_sweep(mesh, {0.0, 0.0, kRadius}, profile, at_least(6, 64 * detail));
}

}  // namespace

void append_stadium(TriangleMesh& mesh, double detail) {
  append_ground(mesh, detail);
  const int segments = at_least(16, 256 * detail);
  const int rows = at_least(1, 30 * detail);
  append_tier(mesh, {0.0, 1.2, 24.0, 12.0, rows}, segments, detail);
  append_tier(mesh, {27.0, 17.5, 24.0, 16.0, rows}, segments, detail);
  append_roof(mesh, segments);
  append_plinth(mesh, detail);
}

BuiltinScene teapot_in_stadium(std::size_t size) {
  // Everything is divided along two dimensions, so the triangles grow with the square of `detail`.
  const double detail = std::sqrt(static_cast<double>(size) / static_cast<double>(kTeapotInStadiumSize));
  BuiltinScene scene{{}, {-0.25f, 1.185f, 0.125f}, {0.0f, 1.197f, 0.01f}, {0.0f, 1.0f, 0.0f}, 50.0};
  append_stadium(scene.mesh, detail);
  append_teapot(scene.mesh, at_least(2, 24 * detail), {0.0, kPlinthHeight, 0.0}, 0.0375);
  return scene;
}

}  // namespace plumb::detail
