#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>

#include "cases/cases.h"
#include "support/random.h"

// What the cases are put together from. Coordinates are multiples of 2^-kFixedBits, so that the difference
// of two of them, and points at quarters of an edge, are floats exactly; products of them are not. Of the
// calls below each draws from `random` in one order: never two in one expression.

namespace plumb::cases {

using hard::Random;

inline constexpr int kFixedBits = 20;

/// A multiple of 2^-kFixedBits from -2^exponent up to 2^exponent.
float fixed(Random& random, int exponent = 0);
glm::vec3 fixed3(Random& random, int exponent = 0);

/// A multiple of 2^-12 from -1 to 1 in each component: room for exact sums with others.
glm::vec3 coarse3(Random& random);

/// One of the names, each as likely.
std::string_view one_of(Random& random, std::initializer_list<std::string_view> names);

/// The components in another order: x becomes component `axis`, the others follow in a circle.
template <typename Vector>
Vector turned(const Vector& v, int axis) {
  Vector result(0);
  for (int i = 0; i < 3; ++i) result[(axis + i) % 3] = v[i];
  return result;
}

/// A triangle with vertices of its own.
void add(TriangleMesh& mesh, glm::vec3 v0, glm::vec3 v1, glm::vec3 v2);

/// The same, its corners turned and reversed or not.
void add_turned(Random& random, TriangleMesh& mesh, glm::vec3 v0, glm::vec3 v1, glm::vec3 v2);

/// A bumpy sheet over a 4 x 4 grid in x and y from about -0.75 to 0.75, of 18 triangles that share their
/// vertices, in any order. Heights reach 2^exponent at most, slopes as steep as that makes them.
TriangleMesh sheet(Random& random, int exponent);

/// At quarters of the way from a to b, ends left out: exact for fixed points.
glm::vec3 between(Random& random, glm::vec3 a, glm::vec3 b);

/// A point of one of the mesh's edges, as above.
glm::vec3 on_some_edge(Random& random, const TriangleMesh& mesh);

Ray make_ray(glm::vec3 origin, glm::vec3 direction);

/// From `origin` towards `point`, whose difference is exact for fixed points; then of any length from
/// 2^-8 to 2^8 times that, which is exact as well.
Ray towards(Random& random, glm::vec3 origin, glm::vec3 point);

/// `count` more rays, each of one of the kinds of hard_rays.h.
void aim(Random& random, Instance& instance, int count, std::initializer_list<std::string_view> kinds);

/// A camera whose pixel (x, y) looks along first + x * right + y * down exactly, where these fit a float.
Camera grid_camera(glm::vec3 eye, glm::dvec3 first, glm::dvec3 right, glm::dvec3 down, int width, int height);

/// A camera of 24 x 16 pixels for scenes of small integer coordinates: its eye has such coordinates and its
/// pixels' directions quarters of them, so that rays lie in planes of the scene and meet its vertices.
Camera lattice_camera(Random& random);

/// A camera of 24 x 16 pixels from `eye` to `target` that sees `half_height` above the target, at
/// distance 1 from the eye.
Camera narrow_camera(glm::vec3 eye, glm::vec3 target, double half_height);

}  // namespace plumb::cases
