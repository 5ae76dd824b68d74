#include "structures/bounding_sphere.h"

#include <cmath>
#include <limits>

namespace plumb::detail {
namespace {

struct Farthest {
  glm::vec3 corner;
  double distance;
};

// The corner farthest from `center`. A difference is off by u of itself, u = 2^-53, the square root of the
// sum of three squares by (2 * 1 + 1 + 2) / 2 + 1 < 4 u.
Farthest farthest_corner(MeshView mesh, std::span<const std::uint32_t> triangles, const glm::vec3& center) {
  Farthest farthest{center, 0.0};
  double greatest = 0.0;
  for (const std::uint32_t index : triangles) {
    const glm::uvec3& corners = mesh.triangles[index];
    for (int v = 0; v < 3; ++v) {
      const glm::vec3& p = mesh.positions[corners[v]];
      const double x = double{p.x} - double{center.x}, y = double{p.y} - double{center.y},
                   z = double{p.z} - double{center.z};
      const double square = (x * x + y * y) + z * z;
      if (square > greatest) {
        greatest = square;
        farthest.corner = p;
      }
    }
  }
  farthest.distance = std::sqrt(greatest);
  return farthest;
}

float middle(float lo, float hi) { return static_cast<float>(0.5 * (double{lo} + double{hi})); }

// The next float up is further away than four units of a double.
float radius_of(double distance) {
  if (distance == 0.0) return 0.0f;
  if (distance > double{std::numeric_limits<float>::max()}) return std::numeric_limits<float>::infinity();
  return std::nextafter(static_cast<float>(distance), std::numeric_limits<float>::infinity());
}

// Steps towards the least sphere. Large nodes take a share of them: what they cost adds up over the levels of
// a tree, and their spheres are met by nearly all rays anyway.
int steps_for(std::size_t triangles) {
  if (triangles <= 64) return 16;
  return triangles <= 4096 ? 6 : 2;
}

}  // namespace

Sphere bounding_sphere(MeshView mesh, std::span<const std::uint32_t> triangles, const Box& box) {
  glm::vec3 center{middle(box.lo.x, box.hi.x), middle(box.lo.y, box.hi.y), middle(box.lo.z, box.hi.z)};
  Farthest farthest = farthest_corner(mesh, triangles, center);
  Sphere best{center, radius_of(farthest.distance)};
  // Badoiu and Clarkson 2003, "Smaller core-sets for balls": step i goes 1 / (i + 1) of the way to the
  // farthest point. The box's centre is a better start than the method asks for, so that it begins with small
  // steps.
  const int steps = steps_for(triangles.size());
  for (int i = 0; i < steps; ++i) {
    const double share = 1.0 / (i + 4);
    for (int axis = 0; axis < 3; ++axis) {
      const double from = double{center[axis]};
      center[axis] = static_cast<float>(from + share * (double{farthest.corner[axis]} - from));
    }
    farthest = farthest_corner(mesh, triangles, center);
    const float radius = radius_of(farthest.distance);
    if (radius < best.radius) best = {center, radius};
  }
  return best;
}

}  // namespace plumb::detail
