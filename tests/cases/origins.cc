#include "cases/groups.h"
#include "cases/shape.h"
#include "support/hard_cameras.h"
#include "support/hard_scenes.h"

// Rays that begin where something is.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Origins";
constexpr int kRays = 8;

void begin(Random& random, Instance& instance, std::string_view kind) {
  const std::string_view scene = one_of(random, {"lattice", "solid", "coplanar"});
  instance.mesh = hard::scene_of_kind(random, scene);
  aim(random, instance, kRays, {kind});
}

void on_surface(Random& random, Instance& instance) { begin(random, instance, "from_surface"); }
void on_vertex(Random& random, Instance& instance) { begin(random, instance, "from_vertex"); }
void on_edge(Random& random, Instance& instance) { begin(random, instance, "from_edge"); }
void near_surface(Random& random, Instance& instance) { begin(random, instance, "from_near_surface"); }

void touching_eye(Random& random, Instance& instance) {
  const std::string_view scene = one_of(random, {"lattice", "solid", "soup", "terrain"});
  instance.mesh = hard::scene_of_kind(random, scene);
  instance.camera = hard::camera_of_kind(random, instance.mesh, "touching");
}

constexpr Case kCases[] = {
    {kGroup, "origin-on-surface", "Rays that begin exactly on a triangle.",
     "What is at the origin is at depth 0 and does not count; what is beyond does.", 1, on_surface},
    {kGroup, "origin-on-vertex", "Rays that begin exactly at a vertex.",
     "The edges through the origin have the sign zero: their triangles are missed.", 1, on_vertex},
    {kGroup, "origin-on-edge", "Rays that begin exactly on the line of an edge.",
     "The edge through the origin has the sign zero: its triangles are missed.", 1, on_edge},
    {kGroup, "origin-near-surface", "Rays that begin by 2^-8 to 2^-24 of the scene's size off a triangle.",
     "The smallest depth above 0 counts; there is no distance below which a surface is passed over.", 1,
     near_surface},
    {kGroup, "eye-on-surface", "Frames whose eye lies on a vertex, an edge or a triangle.",
     "There is no near plane: what is beyond the eye is seen from any distance, and what is at it is not.", 4,
     touching_eye},
};

}  // namespace

std::span<const Case> origin_cases() { return kCases; }

}  // namespace plumb::cases
