#include "support/closed_meshes.h"

#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

namespace plumb::hard {
namespace {

/// A mesh whose vertices are found by their coordinates, so that faces that meet share them.
class Lattice {
 public:
  std::uint32_t vertex(double x, double y, double z) {
    const auto [place, is_new] = indices_.try_emplace({std::lround(x), std::lround(y), std::lround(z)},
                                                      static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
      mesh_.positions.emplace_back(static_cast<float>(std::lround(x)), static_cast<float>(std::lround(y)),
                                   static_cast<float>(std::lround(z)));
    }
    return place->second;
  }

  void triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (a != b && b != c && c != a) mesh_.triangles.emplace_back(a, b, c);
  }

  void quad(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }

  TriangleMesh take() { return std::move(mesh_); }

 private:
  TriangleMesh mesh_;
  std::map<std::tuple<long, long, long>, std::uint32_t> indices_;
};

// Each face in n x n squares; `outward` false turns it inside out.
void add_cube(Lattice& lattice, double half, int n, bool outward) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const int side : {-1, 1}) {
      const auto corner = [&](int i, int j) {
        double p[3];
        p[axis] = side * half;
        p[(axis + 1) % 3] = half * (2.0 * i / n - 1.0);
        p[(axis + 2) % 3] = half * (2.0 * j / n - 1.0);
        return lattice.vertex(p[0], p[1], p[2]);
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const std::uint32_t a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1),
                              d = corner(i, j + 1);
          if ((side > 0) == outward) {
            lattice.quad(a, b, c, d);
          } else {
            lattice.quad(d, c, b, a);
          }
        }
      }
    }
  }
}

// A surface of revolution about y whose profile closes on the axis: point k of `steps` at height y(k), radius
// r(k), the first and last of radius 0, from the top down.
template <typename Height, typename Radius>
TriangleMesh turned(int steps, int segments, Height y, Radius r) {
  Lattice lattice;
  const auto point = [&](int k, int s) {
    const double angle = 2.0 * std::numbers::pi * (s % segments) / segments;
    return lattice.vertex(r(k) * std::cos(angle), y(k), -r(k) * std::sin(angle));
  };
  for (int k = 0; k < steps; ++k) {
    for (int s = 0; s < segments; ++s) {
      const std::uint32_t a = point(k, s), b = point(k + 1, s), c = point(k + 1, s + 1), d = point(k, s + 1);
      lattice.quad(a, b, c, d);
    }
  }
  return lattice.take();
}

TriangleMesh torus(int around, int along) {
  Lattice lattice;
  const auto point = [&](int i, int j) {
    const double u = 2.0 * std::numbers::pi * (i % around) / around;
    const double v = 2.0 * std::numbers::pi * (j % along) / along;
    const double radius = 2800.0 + 1200.0 * std::cos(v);
    return lattice.vertex(radius * std::cos(u), 1200.0 * std::sin(v), -radius * std::sin(u));
  };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < along; ++j) {
      const std::uint32_t a = point(i, j), b = point(i + 1, j), c = point(i + 1, j + 1), d = point(i, j + 1);
      lattice.quad(a, b, c, d);
    }
  }
  return lattice.take();
}

}  // namespace

std::vector<ClosedMesh> closed_meshes() {
  std::vector<ClosedMesh> meshes;
  Lattice cube, nested, tetrahedron;
  add_cube(cube, 1024.0, 16, true);
  meshes.push_back({"cube", cube.take()});
  add_cube(nested, 1024.0, 4, true);
  add_cube(nested, 512.0, 4, false);
  meshes.push_back({"cube within a cube", nested.take()});
  const double pi = std::numbers::pi;
  meshes.push_back(
      {"ball", turned(
                   24, 48, [&](int k) { return 4000.0 * std::cos(pi * k / 24.0); },
                   [&](int k) { return k % 24 == 0 ? 0.0 : 4000.0 * std::sin(pi * k / 24.0); })});
  meshes.push_back({"spindle", turned(
                                   2, 40, [](int k) { return 4096.0 * (1 - k); },
                                   [](int k) { return k == 1 ? 9.0 : 0.0; })});
  meshes.push_back({"cones", turned(
                                 2, 1000, [](int k) { return 16.0 * (1 - k); },
                                 [](int k) { return k == 1 ? 4000.0 : 0.0; })});
  meshes.push_back({"torus", torus(40, 24)});
  const std::uint32_t a = tetrahedron.vertex(-7, -5, -3), b = tetrahedron.vertex(4001, 2, 11),
                      c = tetrahedron.vertex(3, 3000, -6), d = tetrahedron.vertex(-1, 13, 2000);
  tetrahedron.triangle(a, c, b);
  tetrahedron.triangle(a, b, d);
  tetrahedron.triangle(a, d, c);
  tetrahedron.triangle(b, c, d);
  meshes.push_back({"tetrahedron", tetrahedron.take()});
  return meshes;
}

bool is_closed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const glm::uvec3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    if (count != 1 || edges.find({edge.second, edge.first}) == edges.end()) return false;
  }
  return !edges.empty();
}

}  // namespace plumb::hard
