#include <cmath>
#include <cstdint>

#include "scene/builtin_scenes.h"
#include "scene/mesh_builder.h"

// Triangles with centres spread evenly through a cube of side 2. Their sides go as the third root of
// the volume there is for each, so that a box of a tree, or a cell of a grid, meets as many at every size.

namespace plumb::detail {
namespace {

// Even through the cube of side 2 about the origin.
glm::dvec3 hash_point(std::uint32_t triangle, std::uint32_t seed) {
  return 2.0 * glm::dvec3(hash_unit(triangle, seed, 1), hash_unit(triangle, seed, 2),
                          hash_unit(triangle, seed, 3)) -
         1.0;
}

// The side of a cube that holds `share` of the volume of one of side 1: Newton's iteration, with nothing but
// basic arithmetic.
double cube_root(double share) {
  double root = 1.0;
  for (int i = 0; i < 64; ++i) root = (2.0 * root + share / (root * root)) / 3.0;
  return root;
}

}  // namespace

BuiltinScene soup(std::size_t size) {
  const double side = 1.5 * cube_root(1.0 / static_cast<double>(size));
  BuiltinScene scene{{}, {1.9f, 1.4f, 3.6f}, {}, {0.0f, 1.0f, 0.0f}, 46.0};
  TriangleMesh& mesh = scene.mesh;
  mesh.positions.reserve(3 * size);
  mesh.triangles.reserve(size);
  for (std::uint32_t i = 0; i < size; ++i) {
    const glm::dvec3 centre = hash_point(i, 0);
    const std::uint32_t a = append_vertex(mesh, centre + side * hash_point(i, 1));
    append_vertex(mesh, centre + side * hash_point(i, 2));
    append_vertex(mesh, centre + side * hash_point(i, 3));
    mesh.triangles.emplace_back(a, a + 1, a + 2);
  }
  return scene;
}

}  // namespace plumb::detail
