#include "cases/shape.h"

#include <cmath>

namespace plumb::cases {

float fixed(Random& random, int exponent) {
  const int limit = 1 << (kFixedBits + exponent);
  return std::ldexp(static_cast<float>(random.between(-limit, limit - 1)), -kFixedBits);
}

glm::vec3 fixed3(Random& random, int exponent) {
  const float x = fixed(random, exponent), y = fixed(random, exponent), z = fixed(random, exponent);
  return {x, y, z};
}

void add(TriangleMesh& mesh, glm::vec3 v0, glm::vec3 v1, glm::vec3 v2) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {v0, v1, v2});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
}

Ray towards(Random& random, glm::vec3 origin, glm::vec3 point) {
  Ray ray;
  ray.origin = origin;
  ray.direction = std::ldexp(1.0f, random.between(-8, 8)) * (point - origin);
  return ray;
}

glm::vec3 between(Random& random, glm::vec3 a, glm::vec3 b) {
  return a + 0.25f * static_cast<float>(random.between(1, 3)) * (b - a);
}

}  // namespace plumb::cases
