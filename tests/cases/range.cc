#include <algorithm>
#include <cmath>

#include "cases/groups.h"
#include "cases/shape.h"
#include "support/hard_cameras.h"
#include "support/hard_rays.h"
#include "support/hard_scenes.h"

// The ends of the floats' range, and what lies beyond.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Ends of the floats' range";
constexpr int kRays = 8;

void extreme_coordinates(Random& random, Instance& instance, std::string_view scene) {
  instance.mesh = hard::scene_of_kind(random, scene);
  aim(random, instance, kRays, {"at_vertex", "at_edge", "at_inside", "from_surface", "anywhere"});
  const std::string_view camera = one_of(random, {"outside", "inside", "lattice", "extreme"});
  instance.camera = hard::camera_of_kind(random, instance.mesh, camera);
}

void huge_coordinates(Random& random, Instance& instance) { extreme_coordinates(random, instance, "huge"); }
void subnormal_coordinates(Random& random, Instance& instance) {
  extreme_coordinates(random, instance, "tiny");
}
void mixed_scales(Random& random, Instance& instance) {
  extreme_coordinates(random, instance, "mixed_scales");
}

// The direction with its greatest component made 2^exponent to 2^(exponent + 1); what is lost is lost.
void stretch(glm::vec3& direction, int exponent) {
  const float size = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  if (size == 0.0f) return;
  const int more = exponent - std::ilogb(size);
  for (int axis = 0; axis < 3; ++axis) direction[axis] = std::ldexp(direction[axis], more);
}

void huge_direction(Random& random, Instance& instance) {
  const std::string_view scene = one_of(random, {"lattice", "solid", "soup", "far_away"});
  instance.mesh = hard::scene_of_kind(random, scene);
  aim(random, instance, kRays, {"at_vertex", "at_edge", "at_inside", "axis_parallel"});
  for (Ray& ray : instance.rays) stretch(ray.direction, random.between(110, 127));
}

// The scene is small too, so that depths stay finite.
void subnormal_direction(Random& random, Instance& instance) {
  const std::string_view scene = one_of(random, {"lattice", "solid", "coplanar", "soup"});
  instance.mesh = hard::scene_of_kind(random, scene);
  aim(random, instance, kRays, {"at_vertex", "at_edge", "at_inside", "axis_parallel"});
  const float scale = std::ldexp(1.0f, -random.between(26, 60));
  for (glm::vec3& v : instance.mesh.positions) v *= scale;
  for (Ray& ray : instance.rays) {
    ray.origin *= scale;
    stretch(ray.direction, random.between(-146, -127));
  }
}

void extreme_camera(Random& random, Instance& instance) {
  const std::string_view scene = one_of(random, {"lattice", "solid", "soup", "terrain"});
  instance.mesh = hard::scene_of_kind(random, scene);
  const std::string_view camera = one_of(random, {"extreme", "degenerate"});
  instance.camera = hard::camera_of_kind(random, instance.mesh, camera);
}

void non_finite_ray(Random& random, Instance& instance) {
  instance.mesh = hard::scene_of_kind(random, "lattice");
  aim(random, instance, kRays, {"not_a_ray"});
}

void non_finite_vertex(Random& random, Instance& instance) {
  instance.mesh = hard::scene_of_kind(random, "non_finite");
  aim(random, instance, kRays, {"at_vertex", "at_edge", "at_inside"});
  const std::string_view camera = one_of(random, {"outside", "inside"});
  instance.camera = hard::camera_of_kind(random, instance.mesh, camera);
}

constexpr Case kCases[] = {
    {kGroup, "huge-coordinates",
     "Triangles with coordinates up to the greatest float, and rays and frames among them.",
     "Exact arithmetic does not overflow: the triangle is seen unless its rounded depth is infinite.", 6,
     huge_coordinates},
    {kGroup, "subnormal-coordinates",
     "Triangles with subnormal coordinates, down to the least, and rays and frames among them.",
     "Subnormal numbers have their full value.", 6, subnormal_coordinates},
    {kGroup, "mixed-scales",
     "Triangles, or vertices, each of its own scale from 2^-126 to 2^126, and rays and frames among them.",
     "No coordinate is small enough to be left out beside another.", 6, mixed_scales},
    {kGroup, "huge-direction", "Ordinary scenes and rays whose directions are 2^110 to 2^127 long.",
     "The length of a direction scales the depth, which may become subnormal or zero, and nothing else.", 1,
     huge_direction},
    {kGroup, "subnormal-direction", "Scenes of size 2^-24 to 2^-60 and rays whose directions are subnormal.",
     "Subnormal directions have their full value; only one of exactly zero sees nothing.", 1,
     subnormal_direction},
    {kGroup, "extreme-camera",
     "Frames whose pixels' directions are subnormal, round to zero or to infinity, and cameras with steps "
     "that are zero, parallel or not finite.",
     "A pixel whose rounded direction is zero or not finite sees nothing, and every other what its ray does.",
     4, extreme_camera},
    {kGroup, "non-finite-ray", "Rays with a NaN, an infinite origin or direction, or a direction of zero.",
     "Such a ray sees nothing.", 1, non_finite_ray},
    {kGroup, "non-finite-vertex", "Meshes in which some shared vertices have a NaN or infinite coordinate.",
     "A triangle with such a vertex is never seen; the others are, with their ids.", 6, non_finite_vertex},
};

}  // namespace

std::span<const Case> range_cases() { return kCases; }

}  // namespace plumb::cases
