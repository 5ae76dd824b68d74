#include "support/hard_scenes.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <vector>

#include <glm/vec2.hpp>

namespace plumb::hard {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kMax = std::numeric_limits<float>::max();

// Of corners numbered by the bits x + 2 y + 4 z.
constexpr glm::uvec3 kCubeFaces[] = {{0, 1, 3}, {0, 3, 2}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                     {2, 3, 7}, {2, 7, 6}, {0, 2, 6}, {0, 6, 4}, {1, 3, 7}, {1, 7, 5}};

using Corners = std::array<glm::vec3, 3>;

// A mesh that shares no vertex.
TriangleMesh mesh_of(const std::vector<Corners>& triangles) {
  TriangleMesh mesh;
  for (const Corners& corners : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), corners.begin(), corners.end());
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

// `count` triangles whose corners `corner` makes.
template <typename Corner>
std::vector<Corners> triangles_of(int count, const Corner& corner) {
  std::vector<Corners> triangles;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 v0 = corner(), v1 = corner(), v2 = corner();
    triangles.push_back({v0, v1, v2});
  }
  return triangles;
}

// Rotates the corners, and reverses them or not.
Corners turned(Random& random, const Corners& c) {
  const std::uint32_t first = random.below(3);
  const std::uint32_t step = random.one_in(2) ? 1 : 2;
  return {c[first], c[(first + step) % 3], c[(first + 2 * step) % 3]};
}

TriangleMesh soup(Random& random) {
  return mesh_of(triangles_of(24, [&] { return random.unit3(); }));
}

// Coordinates so small and even that products are exact and ties are common; zeros of both signs.
TriangleMesh lattice(Random& random) {
  return mesh_of(triangles_of(24, [&] {
    glm::vec3 v = random.lattice3(3);
    for (int axis = 0; axis < 3; ++axis) {
      if (v[axis] == 0.0f && random.one_in(2)) v[axis] = -0.0f;
    }
    return v;
  }));
}

// A closed octahedron or cube about a lattice point.
TriangleMesh solid(Random& random) {
  TriangleMesh mesh;
  const glm::vec3 centre = random.lattice3(2);
  const float radius = static_cast<float>(random.between(1, 3));
  if (random.one_in(2)) {
    for (int i = 0; i < 6; ++i) {
      glm::vec3 offset(0.0f);
      offset[i / 2] = i % 2 == 0 ? radius : -radius;
      mesh.positions.push_back(centre + offset);
    }
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  } else {
    for (int i = 0; i < 8; ++i) {
      mesh.positions.push_back(centre + radius * glm::vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    }
    mesh.triangles.assign(std::begin(kCubeFaces), std::end(kCubeFaces));
  }
  random.shuffle(mesh.triangles);
  return mesh;
}

// Cuboids across the axes, apart from each other, with integer corners so large that reciprocals round:
// rays meet the edges and corners of bounding boxes, where their near and far planes tie.
TriangleMesh cuboids(Random& random) {
  TriangleMesh mesh;
  for (int i = 0; i < 5; ++i) {
    const glm::vec3 lo = random.lattice3(400);
    const glm::vec3 hi = lo + random.lattice3(60);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int k = 0; k < 8; ++k) {
      mesh.positions.emplace_back(k & 1 ? hi.x : lo.x, k & 2 ? hi.y : lo.y, k & 4 ? hi.z : lo.z);
    }
    for (const glm::uvec3& face : kCubeFaces) mesh.triangles.push_back(face + first);
  }
  random.shuffle(mesh.triangles);
  return mesh;
}

// Triangles around one vertex.
TriangleMesh fan(Random& random) {
  TriangleMesh mesh;
  const auto spokes = static_cast<std::uint32_t>(random.between(3, 12));
  mesh.positions.push_back(random.unit3());
  for (std::uint32_t i = 0; i < spokes; ++i) {
    // Around a square, so that the fan is a proper one without a sine.
    const float s = 8.0f * static_cast<float>(i) / static_cast<float>(spokes);
    const float x = s < 2 ? 1 : s < 4 ? 3 - s : s < 6 ? -1 : s - 7;
    const float y = s < 2 ? s - 1 : s < 4 ? 1 : s < 6 ? 5 - s : -1;
    mesh.positions.push_back(mesh.positions[0] + glm::vec3(x, y, 0.25f * random.unit()));
    mesh.triangles.emplace_back(0u, 1 + i, 1 + (i + 1) % spokes);
  }
  random.shuffle(mesh.triangles);
  return mesh;
}

// A height field with shared vertices, of lattice or of free heights.
TriangleMesh terrain(Random& random) {
  TriangleMesh mesh;
  const bool on_lattice = random.one_in(2);
  constexpr std::uint32_t kSide = 5;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const float height = on_lattice ? static_cast<float>(random.between(-1, 1)) : random.unit();
    mesh.positions.emplace_back(static_cast<float>(i % kSide) - 2.0f, height,
                                static_cast<float>(i / kSide) - 2.0f);
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    mesh.triangles.emplace_back(i, i + 1, i + kSide);
    mesh.triangles.emplace_back(i + 1, i + kSide + 1, i + kSide);
  }
  return mesh;
}

// Two corners a few floats apart, or a third one beside the opposite edge.
TriangleMesh slivers(Random& random) {
  std::vector<Corners> triangles;
  for (int i = 0; i < 20; ++i) {
    const glm::vec3 v0 = random.unit3(), v1 = random.unit3();
    const glm::vec3 beside = random.one_in(2) ? v1 : v0 + 0.5f * (v1 - v0);
    triangles.push_back(turned(random, {v0, v1, nudged(random, beside, 4)}));
  }
  return mesh_of(triangles);
}

TriangleMesh duplicates(Random& random) {
  std::vector<Corners> triangles;
  for (int i = 0; i < 6; ++i) {
    const bool on_lattice = random.one_in(2);
    const auto corner = [&] { return on_lattice ? random.lattice3(2) : random.unit3(); };
    const Corners original = triangles_of(1, corner).front();
    for (int copies = random.between(1, 6); copies > 0; --copies)
      triangles.push_back(turned(random, original));
  }
  random.shuffle(triangles);
  return mesh_of(triangles);
}

// Points, segments and proper triangles side by side.
TriangleMesh degenerate(Random& random) {
  std::vector<Corners> triangles;
  for (int i = 0; i < 24; ++i) {
    const glm::vec3 v0 = random.lattice3(2), v1 = random.lattice3(2), v2 = random.lattice3(2);
    switch (random.below(4)) {
      case 0:
        triangles.push_back({v0, v0, v0});
        break;
      case 1:
        triangles.push_back(turned(random, {v0, v1, v1}));
        break;
      case 2:
        triangles.push_back(
            turned(random, {v0, v1, v0 + static_cast<float>(random.between(-2, 3)) * (v1 - v0)}));
        break;
      default:
        triangles.push_back({v0, v1, v2});
        break;
    }
  }
  return mesh_of(triangles);
}

// NaN and infinite corners among good ones, in a mesh that shares them.
TriangleMesh non_finite(Random& random) {
  TriangleMesh mesh;
  for (int i = 0; i < 16; ++i) mesh.positions.push_back(random.unit3());
  for (int i = 0; i < 3; ++i) {
    const float bad = random.pick(std::vector<float>{std::numeric_limits<float>::quiet_NaN(), kInf, -kInf});
    glm::vec3& position = mesh.positions[random.below(16)];
    position[random.between(0, 2)] = bad;
  }
  for (int i = 0; i < 24; ++i) {
    const std::uint32_t v0 = random.below(16), v1 = random.below(16), v2 = random.below(16);
    mesh.triangles.emplace_back(v0, v1, v2);
  }
  return mesh;
}

// Stacks of triangles a few floats apart, in any order.
TriangleMesh near_ties(Random& random) {
  std::vector<Corners> triangles;
  for (int stack = 0; stack < 3; ++stack) {
    const Corners base = triangles_of(1, [&] { return random.unit3(); }).front();
    for (int i = 0; i < 10; ++i) {
      triangles.push_back(turned(
          random, {nudged(random, base[0], 3), nudged(random, base[1], 3), nudged(random, base[2], 3)}));
    }
  }
  random.shuffle(triangles);
  return mesh_of(triangles);
}

// Overlapping lattice triangles in one plane: across an axis or slanted.
TriangleMesh coplanar(Random& random) {
  const int axis = random.between(0, 2);
  const bool slanted = random.one_in(2);
  const float level = static_cast<float>(random.between(-2, 2));
  return mesh_of(triangles_of(24, [&] {
    glm::vec3 v = random.lattice3(3);
    v[axis] = slanted ? level - v[(axis + 1) % 3] - v[(axis + 2) % 3] : level;
    return v;
  }));
}

// Across an axis at one of a few levels, with free coordinates otherwise: depths are ratios of two
// coordinates, while the arithmetic around them rounds.
TriangleMesh flat(Random& random) {
  const int axis = random.between(0, 2);
  std::vector<Corners> triangles;
  for (int i = 0; i < 20; ++i) {
    Corners c = {random.unit3(), random.unit3(), random.unit3()};
    const float side = random.one_in(2) ? 1.0f : -1.0f;
    const float level = std::ldexp(side, random.between(-1, 1));
    for (glm::vec3& v : c) v[axis] = level;
    triangles.push_back(c);
  }
  return mesh_of(triangles);
}

// Seen from the origin, all three edges of every triangle nearly coincide with one plane, and the
// triangle's own plane nearly holds the origin: (p, q) and (r, s) are neighbours in the Stern-Brocot
// tree, p s - q r = 1, so determinants of large integers are 0, 1 or little more. See from_zero in
// hard_rays.cc.
TriangleMesh unimodular(Random& random) {
  std::vector<Corners> triangles;
  for (int i = 0; i < 20; ++i) {
    glm::vec2 left(0, 1), right(1, 0);
    const float limit = std::ldexp(1.0f, random.between(6, 22));
    while (left.x + right.x < limit && left.y + right.y < limit) {
      (random.one_in(2) ? left : right) = left + right;
    }
    const float x0 = std::round(0.5f * limit * random.unit()), x1 = std::round(0.5f * limit * random.unit());
    const float lift = static_cast<float>(random.between(-3, 3));
    triangles.push_back({glm::vec3{x0, left}, glm::vec3{x1, right}, glm::vec3{x0 + x1 + lift, left + right}});
  }
  return mesh_of(triangles);
}

// One centre: centroids and nested boxes all agree.
TriangleMesh concentric(Random& random) {
  std::vector<Corners> triangles;
  for (int i = 0; i < 16; ++i) {
    const glm::vec3 v0 = random.lattice3(4), v1 = random.lattice3(4);
    triangles.push_back({v0, v1, -(v0 + v1)});
  }
  return mesh_of(triangles);
}

// Up to the greatest float.
TriangleMesh huge(Random& random) {
  return mesh_of(triangles_of(20, [&] {
    glm::vec3 v = 0x1.fffffcp127f * random.unit3();
    if (random.one_in(4)) {
      const int axis = random.between(0, 2);
      v[axis] = random.one_in(2) ? kMax : -kMax;
    }
    return v;
  }));
}

// Down to the least subnormal.
TriangleMesh tiny(Random& random) {
  const float unit = random.one_in(2) ? 0x1p-149f : 0x1p-130f;
  return mesh_of(triangles_of(20, [&] { return unit * random.lattice3(20); }));
}

// Every triangle, or every corner, of its own scale.
TriangleMesh mixed_scales(Random& random) {
  const bool by_corner = random.one_in(2);
  const int widest = random.one_in(2) ? 20 : 126;
  int exponent = 0;
  int corners = 0;
  return mesh_of(triangles_of(24, [&] {
    if (by_corner || corners++ % 3 == 0) exponent = random.between(-widest, widest);
    return std::ldexp(1.0f, exponent) * random.unit3();
  }));
}

// A scene of size 1 far from the origin, where floats are coarse.
TriangleMesh far_away(Random& random) {
  const float distance = std::ldexp(1.0f, random.between(4, 23));
  const glm::vec3 centre = distance * random.unit3();
  return mesh_of(triangles_of(24, [&] { return centre + random.unit3(); }));
}

// None, one or two triangles.
TriangleMesh few(Random& random) {
  return mesh_of(triangles_of(random.between(0, 2), [&] { return random.lattice3(2); }));
}

// Enough triangles for a tree of some depth, small ones on a grid of shared vertices.
TriangleMesh many(Random& random) {
  TriangleMesh mesh;
  for (int i = 0; i < 125; ++i) {
    mesh.positions.push_back(0.25f * (glm::vec3(i % 5, i / 5 % 5, i / 25) - 2.0f));
  }
  for (int i = 0; i < 300; ++i) {
    // Three of the eight corners of one cell.
    const auto place = [&](std::uint32_t count) {
      const std::uint32_t x = random.below(count), y = random.below(count), z = random.below(count);
      return x + 5 * y + 25 * z;
    };
    const std::uint32_t cell = place(4), v0 = cell + place(2), v1 = cell + place(2), v2 = cell + place(2);
    mesh.triangles.emplace_back(v0, v1, v2);
  }
  return mesh;
}

constexpr SceneKind kKinds[] = {
    {"soup", soup},
    {"lattice", lattice},
    {"solid", solid},
    {"cuboids", cuboids},
    {"fan", fan},
    {"terrain", terrain},
    {"slivers", slivers},
    {"duplicates", duplicates},
    {"degenerate", degenerate},
    {"non_finite", non_finite},
    {"near_ties", near_ties},
    {"coplanar", coplanar},
    {"flat", flat},
    {"unimodular", unimodular},
    {"concentric", concentric},
    {"huge", huge},
    {"tiny", tiny},
    {"mixed_scales", mixed_scales},
    {"far_away", far_away},
    {"few", few},
    {"many", many},
};

}  // namespace

std::span<const SceneKind> scene_kinds() { return kKinds; }

TriangleMesh scene_of_kind(Random& random, std::string_view kind) {
  return kind_called(kKinds, kind).make(random);
}

float nudged(Random& random, float f, int limit) {
  for (int steps = random.between(-limit, limit); steps != 0; steps += steps < 0 ? 1 : -1) {
    const float next = std::nextafter(f, steps < 0 ? -kInf : kInf);
    if (std::isfinite(next)) f = next;
  }
  return f;
}

glm::vec3 nudged(Random& random, glm::vec3 v, int limit) {
  for (int axis = 0; axis < 3; ++axis) v[axis] = nudged(random, v[axis], limit);
  return v;
}

}  // namespace plumb::hard
