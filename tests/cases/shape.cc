#include "cases/shape.h"

#include <array>
#include <cmath>

#include "support/hard_rays.h"

namespace plumb::cases {
namespace {

using Corners = std::array<glm::vec3, 3>;

glm::dvec3 cross(const glm::dvec3& p, const glm::dvec3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

// By operations that are rounded alike everywhere.
glm::dvec3 normalized(const glm::dvec3& v) {
  const double length = std::sqrt((v.x * v.x + v.y * v.y) + v.z * v.z);
  return {v.x / length, v.y / length, v.z / length};
}

}  // namespace

float fixed(Random& random, int exponent) {
  const int limit = 1 << (kFixedBits + exponent);
  return std::ldexp(static_cast<float>(random.between(-limit, limit - 1)), -kFixedBits);
}

glm::vec3 fixed3(Random& random, int exponent) {
  const float x = fixed(random, exponent), y = fixed(random, exponent), z = fixed(random, exponent);
  return {x, y, z};
}

glm::vec3 coarse3(Random& random) { return 0x1p-12f * random.lattice3(1 << 12); }

std::string_view one_of(Random& random, std::initializer_list<std::string_view> names) {
  return names.begin()[random.below(static_cast<std::uint32_t>(names.size()))];
}

void add(TriangleMesh& mesh, glm::vec3 v0, glm::vec3 v1, glm::vec3 v2) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {v0, v1, v2});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
}

void add_turned(Random& random, TriangleMesh& mesh, glm::vec3 v0, glm::vec3 v1, glm::vec3 v2) {
  const Corners c = {v0, v1, v2};
  const std::uint32_t first = random.below(3);
  const std::uint32_t step = random.one_in(2) ? 1 : 2;
  add(mesh, c[first], c[(first + step) % 3], c[(first + 2 * step) % 3]);
}

TriangleMesh sheet(Random& random, int exponent) {
  constexpr std::uint32_t kSide = 4;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    glm::vec3 corner(0.5f * static_cast<float>(i % kSide) - 0.75f,
                     0.5f * static_cast<float>(i / kSide) - 0.75f, 0.0f);
    corner.x += fixed(random, -3);
    corner.y += fixed(random, -3);
    corner.z = fixed(random, exponent);
    mesh.positions.push_back(corner);
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    mesh.triangles.emplace_back(i, i + 1, i + kSide);
    mesh.triangles.emplace_back(i + 1, i + kSide + 1, i + kSide);
  }
  random.shuffle(mesh.triangles);
  return mesh;
}

glm::vec3 between(Random& random, glm::vec3 a, glm::vec3 b) {
  return a + 0.25f * static_cast<float>(random.between(1, 3)) * (b - a);
}

glm::vec3 on_some_edge(Random& random, const TriangleMesh& mesh) {
  const glm::uvec3 triangle = random.pick(mesh.triangles);
  const int corner = random.between(0, 2);
  return between(random, mesh.positions[triangle[corner]], mesh.positions[triangle[(corner + 1) % 3]]);
}

Ray make_ray(glm::vec3 origin, glm::vec3 direction) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

Ray towards(Random& random, glm::vec3 origin, glm::vec3 point) {
  return make_ray(origin, std::ldexp(1.0f, random.between(-8, 8)) * (point - origin));
}

void aim(Random& random, Instance& instance, int count, std::initializer_list<std::string_view> kinds) {
  for (int i = 0; i < count; ++i) {
    const std::string_view kind = one_of(random, kinds);
    instance.rays.push_back(hard::ray_of_kind(random, instance.mesh, kind));
  }
}

Camera grid_camera(glm::vec3 eye, glm::dvec3 first, glm::dvec3 right, glm::dvec3 down, int width,
                   int height) {
  return Camera(eye, (first - 0.5 * right) - 0.5 * down, right, down, width, height);
}

Camera lattice_camera(Random& random) {
  const int axis = random.between(0, 2);
  const float side = random.one_in(2) ? 1.0f : -1.0f;
  const auto x = static_cast<float>(random.between(-2, 2)), y = static_cast<float>(random.between(-2, 2));
  const glm::vec3 eye = turned(glm::vec3(-side * static_cast<float>(random.between(2, 6)), x, y), axis);
  return grid_camera(eye, turned(glm::dvec3(4.0 * side, -3.0, 2.0), axis),
                     turned(glm::dvec3(0, 0.25, 0), axis), turned(glm::dvec3(0, 0, -0.25), axis), 24, 16);
}

Camera narrow_camera(glm::vec3 eye, glm::vec3 target, double half_height) {
  constexpr int kWidth = 24, kHeight = 16;
  const glm::dvec3 forward = normalized(glm::dvec3(target) - glm::dvec3(eye));
  const glm::dvec3 up = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = normalized(cross(forward, up));
  const double pixel = 2.0 * half_height / kHeight;
  const glm::dvec3 du = pixel * right, dv = -pixel * cross(right, forward);
  return Camera(eye, (forward - 0.5 * kWidth * du) - 0.5 * kHeight * dv, du, dv, kWidth, kHeight);
}

}  // namespace plumb::cases
