#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "plumb/mesh.h"
#include "support/random.h"

// Seeded scenes for the tests of builders: ordinary ones and troublesome ones.

namespace build_scenes {

using plumb::TriangleMesh;

using plumb::hard::Random;

inline float uniform(Random& random, float lo, float hi) {
  return lo + (hi - lo) * 0.5f * (random.unit() + 1.0f);
}

inline glm::vec3 point(Random& random, float lo, float hi) {
  return lo + (hi - lo) * 0.5f * (random.unit3() + 1.0f);
}

struct Scene {
  std::string name;
  TriangleMesh mesh;
};

inline void add(TriangleMesh& mesh, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
}

/// Triangles of about `size` with their first corner in the cube of +-`reach`.
inline TriangleMesh soup(std::uint32_t count, float reach, float size, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 a = point(random, -reach, reach);
    const glm::vec3 b = a + point(random, -size, size);
    add(mesh, a, b, a + point(random, -size, size));
  }
  return mesh;
}

/// A height field of 2 * n * n triangles with shared vertices.
inline TriangleMesh grid(std::uint32_t n, float height, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t y = 0; y <= n; ++y) {
    for (std::uint32_t x = 0; x <= n; ++x) {
      mesh.positions.emplace_back(static_cast<float>(x), uniform(random, 0.0f, height),
                                  static_cast<float>(y));
    }
  }
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const std::uint32_t corner = y * (n + 1) + x;
      mesh.triangles.emplace_back(corner, corner + 1, corner + n + 1);
      mesh.triangles.emplace_back(corner + 1, corner + n + 2, corner + n + 1);
    }
  }
  return mesh;
}

/// A small dense ball of triangles inside a vast ring of large ones.
inline TriangleMesh teapot_in_stadium(std::uint32_t count, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const bool stadium = i % 4 == 0;
    glm::vec3 a = point(random, -1.0f, 1.0f);
    if (stadium) a *= 1000.0f / std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    const float size = stadium ? 40.0f : 0.02f;
    const glm::vec3 b = a + point(random, -size, size);
    add(mesh, a, b, a + point(random, -size, size));
  }
  return mesh;
}

/// Sizes and places over all powers of two: binning peels off a few triangles at a time.
inline TriangleMesh exponential(std::uint32_t count, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float scale = std::ldexp(1.0f, static_cast<int>(random.below(240)) - 120);
    const glm::vec3 a = point(random, 0.5f, 1.0f) * scale;
    add(mesh, a, a + point(random, 0.0f, 0.1f) * scale, a + point(random, 0.0f, 0.1f) * scale);
  }
  return mesh;
}

/// Triangles around one point, so that all boxes have one centre.
inline TriangleMesh concentric(std::uint32_t count) {
  TriangleMesh mesh;
  for (std::uint32_t i = 1; i <= count; ++i) {
    const auto r = static_cast<float>(i);
    add(mesh, {-r, -r, -r}, {r, r, r}, {r, -r, 0.0f});
  }
  return mesh;
}

inline TriangleMesh repeated(std::uint32_t count) {
  TriangleMesh mesh;
  mesh.positions = {{0.25f, 0.5f, 1.0f}, {1.5f, 0.5f, 1.0f}, {0.25f, 2.0f, -1.0f}};
  mesh.triangles.assign(count, {0, 1, 2});
  return mesh;
}

inline void spoil(TriangleMesh& mesh, std::uint64_t seed) {
  Random random(seed);
  const float bad[] = {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                       -std::numeric_limits<float>::infinity()};
  for (std::size_t i = 0; i < mesh.positions.size() / 20 + 1; ++i) {
    auto& position = mesh.positions[random.below(static_cast<std::uint32_t>(mesh.positions.size()))];
    const auto axis = static_cast<int>(random.below(3));
    position[axis] = bad[random.below(3)];
  }
}

/// All kinds, of about `count` triangles each.
inline std::vector<Scene> all(std::uint32_t count) {
  constexpr float kMax = std::numeric_limits<float>::max();
  std::vector<Scene> scenes;
  scenes.push_back({"soup", soup(count, 10.0f, 0.3f, 1)});
  scenes.push_back({"grid", grid(static_cast<std::uint32_t>(std::sqrt(count / 2)), 3.0f, 2)});
  scenes.push_back({"flat grid", grid(static_cast<std::uint32_t>(std::sqrt(count / 2)), 0.0f, 3)});
  scenes.push_back({"teapot in stadium", teapot_in_stadium(count, 4)});
  scenes.push_back({"exponential", exponential(count, 5)});
  scenes.push_back({"concentric", concentric(count)});
  scenes.push_back({"one triangle repeated", repeated(count)});
  scenes.push_back({"huge", soup(count, kMax / 4, kMax / 2, 6)});
  scenes.push_back({"subnormal", soup(count, 1e-39f, 1e-40f, 7)});
  scenes.push_back({"large among small", soup(count, 1.0f, 1e-3f, 8)});
  for (std::size_t i = 0; i < scenes.back().mesh.positions.size(); i += 97) {
    scenes.back().mesh.positions[i] *= 1e30f;
  }
  scenes.push_back({"points", soup(count, 1.0f, 0.0f, 9)});
  scenes.push_back({"slivers", soup(count, 1.0f, 0.0f, 10)});
  for (std::size_t i = 1; i < scenes.back().mesh.positions.size(); i += 3)
    scenes.back().mesh.positions[i].x += 5.0f;
  scenes.push_back({"line", soup(count, 1.0f, 0.1f, 11)});
  for (auto& position : scenes.back().mesh.positions) position.y = position.z = 0.0f;
  scenes.push_back({"each triangle four times", soup(count / 4, 2.0f, 0.1f, 12)});
  auto& triangles = scenes.back().mesh.triangles;
  const std::vector<glm::uvec3> once = triangles;
  for (int i = 0; i < 3; ++i) triangles.insert(triangles.end(), once.begin(), once.end());
  scenes.push_back({"negative zeros", soup(count, 1.0f, 0.5f, 13)});
  for (std::size_t i = 0; i < scenes.back().mesh.positions.size(); i += 2)
    scenes.back().mesh.positions[i].x = i % 4 == 0 ? -0.0f : 0.0f;
  scenes.push_back({"not all finite", soup(count, 10.0f, 0.3f, 14)});
  spoil(scenes.back().mesh, 15);
  return scenes;
}

}  // namespace build_scenes
