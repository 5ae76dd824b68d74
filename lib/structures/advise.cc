#include "plumb/advise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "base/fp_mode.h"
#include "build/box.h"
#include "build/clip_triangle.h"
#include "build/mesh_check.h"
#include "exact/intersect.h"
#include "plumb/error.h"
#include "structures/grid_scene.h"

namespace plumb {
namespace {

using detail::Box;

// All of them are asked in less time than a tree's nodes are.
constexpr std::size_t kFew = 24;
// Triangles' boxes over a point of the scene's box, on average, from which on boxes around whole triangles
// tell little.
constexpr double kManyBoxes = 30.0;
// Rays a triangle for which a k-d tree's slower build is worth while, and until which a grid's faster one is.
constexpr double kManyRays = 10.0, kFewRays = 0.4;
// Triangles in the fullest of as many cells as triangles: in even scenes some ten, in a teapot in a stadium
// thousands.
constexpr std::uint32_t kEvenCell = 40;

struct SceneStatistics {
  std::size_t triangles = 0;  // finite ones
  Box box = detail::empty_box();
  double boxes_over_a_point = 0.0;
  std::uint32_t fullest_cell = 0;
};

double extent(const Box& box, int axis) { return double{box.hi[axis]} - double{box.lo[axis]}; }

// Calls visit(box) for the box of each finite triangle.
template <typename Visit>
void for_each_box(MeshView mesh, const Visit& visit) {
  for (const glm::uvec3& corners : mesh.triangles) {
    const detail::Triangle t{mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
    if (detail::triangle_is_finite(t)) visit(detail::box_of(t));
  }
}

SceneStatistics statistics_of(MeshView mesh) {
  SceneStatistics scene;
  for_each_box(mesh, [&](const Box& box) {
    ++scene.triangles;
    for (int axis = 0; axis < 3; ++axis) {
      scene.box.lo[axis] = std::min(scene.box.lo[axis], box.lo[axis]);
      scene.box.hi[axis] = std::max(scene.box.hi[axis], box.hi[axis]);
    }
  });
  if (scene.triangles == 0) return scene;
  const double side = std::cbrt(static_cast<double>(scene.triangles));
  const int cells = std::clamp(static_cast<int>(side), 1, 400);
  std::array<detail::GridAxis, 3> axis;
  for (int a = 0; a < 3; ++a)
    axis[static_cast<std::size_t>(a)] =
        detail::GridAxis::cut(scene.box.lo[a], scene.box.hi[a], extent(scene.box, a) > 0.0 ? cells : 1);
  const auto row = static_cast<std::size_t>(cells);
  std::vector<std::uint32_t> counts(row * row * row, 0);
  for_each_box(mesh, [&](const Box& box) {
    double share = 1.0;  // of the scene's box
    std::size_t cell = 0;
    for (int a = 0; a < 3; ++a) {
      const detail::GridAxis& along = axis[static_cast<std::size_t>(a)];
      if (along.cells > 1) share *= extent(box, a) / extent(scene.box, a);
      cell =
          cell * row + static_cast<std::size_t>(along.index(0.5 * (double{box.lo[a]} + double{box.hi[a]})));
    }
    scene.boxes_over_a_point += share;
    scene.fullest_cell = std::max(scene.fullest_cell, ++counts[cell]);
  });
  return scene;
}

std::string text(const char* format, double value) {
  char buffer[160];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

Advice advice_for(const SceneStatistics& scene, double rays) {
  Advice advice;
  const auto triangles = static_cast<double>(scene.triangles);
  if (scene.triangles <= kFew) {
    advice.settings.kind = StructureKind::BruteForce;
    advice.reason =
        text("With %.0f triangles, asking all of them eight at a time is faster than any tree.", triangles);
  } else if (scene.boxes_over_a_point >= kManyBoxes && rays >= kManyRays * triangles) {
    advice.settings.kind = StructureKind::KdTree;
    advice.reason = text(
        "Its triangles are so large that a point lies in the boxes of %.0f of them, which cells that "
        "cut triangles tell apart and boxes around them do not.",
        scene.boxes_over_a_point);
  } else if (rays <= kFewRays * triangles && scene.fullest_cell <= kEvenCell) {
    advice.settings.kind = StructureKind::UniformGrid;
    advice.reason = text(
        "Its triangles lie evenly, and with %.2g rays a triangle the time goes to the build, of which a "
        "grid takes least.",
        rays / triangles);
  } else {
    advice.settings.quality = rays < 2.0 * triangles ? Quality::Fast : Quality::Balanced;
    advice.reason =
        advice.settings.quality == Quality::Fast
            ? text("With %.2g rays a triangle a tree built quickly takes the least time in all.",
                   rays / triangles)
            : text(
                  "Boxes around its %.0f triangles tell them apart well, and a wide tree of them is asked "
                  "and built fast.",
                  triangles);
  }
  return advice;
}

}  // namespace

Advice advise(MeshView mesh, double rays) {
  if (!(rays > 0.0)) throw Error("plumb: advise: rays is " + std::to_string(rays) + "; it must be above 0");
  detail::check_mesh(mesh, 0, "advise");
  Advice advice;
  detail::with_default_fp_mode([&] { advice = advice_for(statistics_of(mesh), rays); });
  return advice;
}

}  // namespace plumb
