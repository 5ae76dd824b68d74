#include <algorithm>
#include <cmath>
#include <cstdint>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// Octahedra whose faces are divided evenly and whose vertices are then moved to the sphere. Vertices are
// shared, so that every sphere is a closed surface; spheres overlap, and few are large.

namespace plumb::detail {
namespace {

// Appends a sphere of 8 n^2 triangles, their corners in counter-clockwise order seen from outside.
void append_sphere(TriangleMesh& mesh, const glm::dvec3& centre, double radius, int n) {
  // The octahedron |x| + |y| + |z| = n in rings of equal y, from +n down to -n: ring r has
  // 4 (n - |n - r|) points, or one at a pole.
  const auto steps = [n](int ring) { return n - std::abs(n - ring); };  // along a quarter of the ring
  std::uint32_t ring_start = 0, above_start = 0;
  for (int ring = 0; ring <= 2 * n; ++ring) {
    const int m = steps(ring);
    above_start = ring_start;
    ring_start = static_cast<std::uint32_t>(mesh.positions.size());
    for (int i = 0; i < std::max(1, 4 * m); ++i) {
      const int quarter = m == 0 ? 0 : i / m, step = m == 0 ? 0 : i % m;
      double x = m - step, z = step;
      for (int turned = 0; turned < quarter; ++turned) {
        const double old_x = x;
        x = -z;
        z = old_x;
      }
      const glm::dvec3 p(x, n - ring, z);
      const double length = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
      append_vertex(mesh, centre + radius * p / length);
    }
    if (ring == 0) continue;
    // The strip between this ring and the one above: the wider of the two has one step more in each quarter.
    const bool grows = ring <= n;
    const int wide = grows ? m : steps(ring - 1);
    const std::uint32_t wide_start = grows ? ring_start : above_start;
    const std::uint32_t narrow_start = grows ? above_start : ring_start;
    const auto on = [](std::uint32_t start, int index, int points) {
      return start + static_cast<std::uint32_t>(points == 0 ? 0 : index % points);
    };
    for (int quarter = 0; quarter < 4; ++quarter) {
      for (int step = 0; step < wide; ++step) {
        const int w = quarter * wide + step, k = quarter * (wide - 1) + step;
        const std::uint32_t here = on(wide_start, w, 4 * wide), next = on(wide_start, w + 1, 4 * wide);
        const std::uint32_t other = on(narrow_start, k, 4 * (wide - 1));
        if (grows) {
          mesh.triangles.emplace_back(here, other, next);
        } else {
          mesh.triangles.emplace_back(here, next, other);
        }
        if (step + 1 == wide) continue;
        const std::uint32_t beside = on(narrow_start, k + 1, 4 * (wide - 1));
        if (grows) {
          mesh.triangles.emplace_back(next, other, beside);
        } else {
          mesh.triangles.emplace_back(next, beside, other);
        }
      }
    }
  }
}

}  // namespace

BuiltinScene spheres(std::size_t size) {
  // Both the number of spheres and their triangles grow, each about as the square root of the size.
  const double wanted = static_cast<double>(size);
  const double most = std::max(1.0, std::floor(0.5 * std::sqrt(wanted)));
  const int n = std::max(1, static_cast<int>(std::floor(std::sqrt(wanted / (8.0 * most)) + 0.5)));
  const auto count = static_cast<std::uint32_t>(std::max(1.0, std::floor(wanted / (8.0 * n * n) + 0.5)));
  BuiltinScene scene{{}, {2.2f, 1.6f, 4.2f}, {}, {0.0f, 1.0f, 0.0f}, 43.0};
  scene.mesh.positions.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(4 * n * n + 2));
  scene.mesh.triangles.reserve(static_cast<std::size_t>(count) * static_cast<std::size_t>(8 * n * n));
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 centre =
        2.4 * glm::dvec3(hash_unit(i, 0, 1), hash_unit(i, 0, 2), hash_unit(i, 0, 3)) - 1.2;
    const double rarity = hash_unit(i, 0, 4);
    append_sphere(scene.mesh, centre, 0.02 + 0.3 * rarity * rarity * rarity * rarity, n);
  }
  return scene;
}

}  // namespace plumb::detail
