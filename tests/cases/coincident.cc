#include "cases/groups.h"
#include "cases/shape.h"
#include "support/hard_cameras.h"
#include "support/hard_scenes.h"

// Surfaces in one place.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Coincident surfaces";
constexpr int kRays = 8;

// Parallelograms split along either diagonal, whole triangles turned and reversed, all in one place.
void coincident(Random& random, Instance& instance) {
  TriangleMesh& mesh = instance.mesh;
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 a = fixed3(random, -1), p = fixed3(random, -1), q = fixed3(random, -1);
    const glm::vec3 b = a + p, c = b + q, d = a + q;
    const int copies = random.between(1, 2);
    for (int k = 0; k < copies; ++k) {
      add_turned(random, mesh, a, b, c);
      add_turned(random, mesh, a, c, d);
      add_turned(random, mesh, a, b, d);
      add_turned(random, mesh, b, c, d);
    }
  }
  random.shuffle(mesh.triangles);
  for (int i = 0; i < kRays; ++i) {
    const glm::uvec3 triangle = random.pick(mesh.triangles);
    const glm::vec3 edge_point = between(random, mesh.positions[triangle.x], mesh.positions[triangle.y]);
    const glm::vec3 point = 0.5f * edge_point + 0.5f * mesh.positions[triangle.z];
    const glm::vec3 origin = fixed3(random);
    instance.rays.push_back(towards(random, origin, point));
  }
  instance.camera = hard::camera_of_kind(random, mesh, "outside");
}

void coplanar(Random& random, Instance& instance) {
  instance.mesh = hard::scene_of_kind(random, "coplanar");
  aim(random, instance, kRays, {"at_inside", "at_edge", "at_vertex"});
  instance.camera = hard::camera_of_kind(random, instance.mesh, "outside");
}

void duplicates(Random& random, Instance& instance) {
  constexpr int kCopies = 1000;
  TriangleMesh& mesh = instance.mesh;
  const glm::vec3 a = fixed3(random), b = fixed3(random), c = fixed3(random);
  for (int i = 0; i < kCopies; ++i) add_turned(random, mesh, a, b, c);
  for (int i = 0; i < 8; ++i) {
    const glm::vec3 v0 = fixed3(random), v1 = fixed3(random), v2 = fixed3(random);
    add(mesh, v0, v1, v2);
  }
  random.shuffle(mesh.triangles);
  for (int i = 0; i < 4; ++i) {
    const glm::vec3 edge_point = between(random, a, b);
    const glm::vec3 origin = fixed3(random);
    instance.rays.push_back(towards(random, origin, 0.5f * edge_point + 0.5f * c));
  }
  const glm::vec3 eye = fixed3(random);
  instance.camera =
      grid_camera(eye, glm::dvec3(0.25f * (a + b) + 0.5f * c - eye) - glm::dvec3(0.125, 0.125, 0),
                  {0.125, 0.0, 0.0}, {0.0, 0.125, 0.0}, 3, 3);
}

constexpr Case kCases[] = {
    {kGroup, "coincident",
     "Parallelograms, each split along one diagonal and along the other, their triangles turned, reversed "
     "and "
     "repeated.",
     "Triangles at one depth are told apart by their ids alone: the lowest is seen.", 6, coincident},
    {kGroup, "coplanar", "24 overlapping triangles in one plane, across an axis or slanted.",
     "Every one of them is at the same exact depth: the lowest id that covers the ray is seen.", 6, coplanar},
    {kGroup, "duplicates", "One triangle a thousand times, turned and reversed, among others.",
     "Equal triangles with different ids are different hits, and the lowest id is seen.", 10, duplicates},
};

}  // namespace

std::span<const Case> coincident_cases() { return kCases; }

}  // namespace plumb::cases
