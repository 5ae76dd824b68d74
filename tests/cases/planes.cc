#include <cstdint>
#include <vector>

#include "cases/groups.h"
#include "cases/shape.h"
#include "support/hard_rays.h"
#include "support/hard_scenes.h"

// Rays in planes, along axes and nearly so.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Planes, boxes and axes";
constexpr int kRays = 8;

float signed_zero(Random& random) { return random.one_in(2) ? 0.0f : -0.0f; }

void in_plane(Random& random, Instance& instance) {
  const std::string_view scene = one_of(random, {"coplanar", "lattice", "solid", "terrain"});
  instance.mesh = hard::scene_of_kind(random, scene);
  aim(random, instance, kRays, {"in_plane"});
  instance.camera = lattice_camera(random);
}

void box_face(Random& random, Instance& instance) {
  instance.mesh = hard::scene_of_kind(random, "cuboids");
  for (int i = 0; i < kRays; ++i) {
    // Vertex k of a cuboid differs from k ^ 1, k ^ 2 and k ^ 4 on one axis each.
    const std::vector<glm::vec3>& positions = instance.mesh.positions;
    const std::uint32_t corner = random.below(static_cast<std::uint32_t>(positions.size()));
    const int axis = random.between(0, 2), along = (axis + random.between(1, 2)) % 3;
    const glm::vec3 point = between(random, positions[corner], positions[corner ^ (1u << along)]);
    glm::vec3 origin = random.lattice3(500);
    origin[axis] = point[axis];
    glm::vec3 direction = point - origin;
    direction[axis] = signed_zero(random);
    instance.rays.push_back(make_ray(origin, direction));
  }
}

// Each ray twice, with other signs of the zeros.
void axis_parallel(Random& random, Instance& instance) {
  const std::string_view scene = one_of(random, {"lattice", "solid", "cuboids"});
  instance.mesh = hard::scene_of_kind(random, scene);
  for (int i = 0; i < kRays / 2; ++i) {
    Ray ray = hard::ray_of_kind(random, instance.mesh, "axis_parallel");
    instance.rays.push_back(ray);
    for (int k = 0; k < 3; ++k) {
      if (ray.direction[k] == 0.0f) ray.direction[k] = -ray.direction[k];
    }
    instance.rays.push_back(ray);
  }
}

void one_zero(Random& random, Instance& instance) {
  instance.mesh = sheet(random, -1);
  for (int i = 0; i < kRays; ++i) {
    glm::vec3 origin = fixed3(random);
    const glm::vec3 point = on_some_edge(random, instance.mesh);
    const int axis = random.between(0, 2);
    origin[axis] = point[axis];
    Ray ray = towards(random, origin, point);
    ray.direction[axis] = signed_zero(random);
    instance.rays.push_back(ray);
  }
}

// A sheet with heights of 2^-12 at most, seen from its own height.
void grazing(Random& random, Instance& instance) {
  constexpr int kHeight = -12;
  const int axis = random.between(0, 2);
  instance.mesh = sheet(random, kHeight);
  for (glm::vec3& v : instance.mesh.positions) v = turned(v, axis);
  const auto outside = [&](float x) {
    const float y = fixed(random), z = fixed(random, kHeight);
    return turned(glm::vec3(x, y, z), axis);
  };
  for (int i = 0; i < kRays; ++i) {
    const glm::vec3 origin = outside(-1.0f), target = outside(1.0f);
    instance.rays.push_back(towards(random, origin, target));
  }
  const glm::vec3 eye = outside(-1.0f);
  instance.camera = narrow_camera(eye, turned(glm::vec3(1, 0, 0), axis), 0x1p-11);
}

constexpr Case kCases[] = {
    {kGroup, "in-plane",
     "Scenes of small integer coordinates and rays between two points of a triangle's plane; frames from "
     "eyes "
     "that lie in such planes.",
     "A ray in a triangle's plane misses it, for the depth's denominator is zero, and sees what else is in "
     "the "
     "way.",
     6, in_plane},
    {kGroup, "box-face",
     "Axis-parallel cuboids and rays that run exactly in the plane of a face, through a point of "
     "one of its edges.",
     "A ray in the plane of a face misses that face; boxes around triangles are no thinner than the "
     "triangles, so nothing in them is lost.",
     1, box_face},
    {kGroup, "axis-parallel",
     "Scenes of small integer coordinates and rays along an axis or a coordinate plane, each once with +0 "
     "and "
     "once with -0 in the other components.",
     "-0 is 0: either ray sees the same.", 1, axis_parallel},
    {kGroup, "one-zero-component",
     "A bumpy sheet and rays aimed exactly at its edges with one component of the direction 0 or -0.",
     "A zero component is no special case: one triangle of an edge inside the sheet is hit.", 1, one_zero},
    {kGroup, "grazing",
     "A sheet 4000 times as wide as it is high and rays that cross it from side to side at its own height; "
     "frames of the same.",
     "The steepness of a hit changes nothing: signs and depth are those of exact arithmetic.", 6, grazing},
};

}  // namespace

std::span<const Case> plane_cases() { return kCases; }

}  // namespace plumb::cases
