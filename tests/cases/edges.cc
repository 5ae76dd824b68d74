#include <array>

#include "cases/groups.h"
#include "cases/shape.h"
#include "support/hard_scenes.h"

// Rays through the edges and vertices of surfaces.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Edges and vertices";
constexpr int kRays = 8;

// Above or below all of a sheet.
glm::vec3 off_the_sheet(Random& random) {
  glm::vec3 origin = fixed3(random);
  origin.z = random.one_in(2) ? 1.0f : -1.0f;
  return origin;
}

void shared_edge(Random& random, Instance& instance) {
  instance.mesh = sheet(random, -3);
  for (int i = 0; i < kRays; ++i) {
    const glm::vec3 point = on_some_edge(random, instance.mesh);
    const glm::vec3 origin = off_the_sheet(random);
    instance.rays.push_back(towards(random, origin, point));
  }
}

// Point k of 16 around a square.
glm::vec3 ring(std::uint32_t k) {
  const float along = 0.5f * static_cast<float>(k % 4) - 1.0f;
  const std::array<glm::vec3, 4> sides = {glm::vec3(1, along, 0), glm::vec3(-along, 1, 0),
                                          glm::vec3(-1, -along, 0), glm::vec3(along, -1, 0)};
  return sides[k / 4];
}

void fan_vertex(Random& random, Instance& instance) {
  TriangleMesh& mesh = instance.mesh;
  const glm::vec3 centre = fixed3(random, -2);
  const auto spokes = static_cast<std::uint32_t>(random.between(3, 12));
  mesh.positions.push_back(centre);
  for (std::uint32_t i = 0; i < spokes; ++i) {
    mesh.positions.push_back(centre + ring(16 * i / spokes) + fixed3(random, -3));
    mesh.triangles.emplace_back(0u, 1 + i, 1 + (i + 1) % spokes);
  }
  random.shuffle(mesh.triangles);
  for (int i = 0; i < kRays; ++i) {
    const glm::vec3 offset = off_the_sheet(random);
    instance.rays.push_back(towards(random, centre + offset, centre));
  }
}

void along_edge(Random& random, Instance& instance) {
  instance.mesh = sheet(random, -3);
  aim(random, instance, kRays, {"along_edge"});
}

void t_junction(Random& random, Instance& instance) {
  TriangleMesh& mesh = instance.mesh;
  const glm::vec3 a = fixed3(random), b = fixed3(random), c = fixed3(random), d = fixed3(random);
  glm::vec3 joint = between(random, a, b);
  if (random.one_in(2)) joint = hard::nudged(random, joint, 2);
  add_turned(random, mesh, a, b, c);
  add_turned(random, mesh, a, joint, d);
  add_turned(random, mesh, joint, b, d);
  random.shuffle(mesh.triangles);
  for (int i = 0; i < kRays; ++i) {
    const glm::vec3 origin = fixed3(random);
    const glm::vec3 point = random.one_in(3) ? joint : between(random, a, b);
    instance.rays.push_back(towards(random, origin, point));
  }
}

void non_manifold_fan(Random& random, Instance& instance) {
  TriangleMesh& mesh = instance.mesh;
  const glm::vec3 a = fixed3(random), b = fixed3(random);
  mesh.positions = {a, b};
  const auto leaves = static_cast<std::uint32_t>(random.between(3, 9));
  for (std::uint32_t i = 0; i < leaves; ++i) {
    mesh.positions.push_back(fixed3(random));
    mesh.triangles.emplace_back(0u, 1u, 2 + i);
  }
  for (int i = 0; i < kRays; ++i) {
    const glm::vec3 origin = fixed3(random);
    const glm::vec3 point = random.one_in(4) ? a : between(random, a, b);
    instance.rays.push_back(towards(random, origin, point));
  }
}

// Vertex (i, j) lies on the eye's ray through (i, j) / 4 in the plane at distance 1, anywhere from 1 to 2
// times as far. Pixels lie at (x, y) / 8.
void edge_pixels(Random& random, Instance& instance) {
  constexpr int kReach = 3, kSide = 2 * kReach + 1;
  TriangleMesh& mesh = instance.mesh;
  const glm::vec3 eye = coarse3(random);
  const int axis = random.between(0, 2);
  for (int i = 0; i < kSide * kSide; ++i) {
    const float distance = 0x1p-13f * static_cast<float>(random.between(1 << 13, 1 << 14));
    const glm::vec3 direction(0.25f * static_cast<float>(i % kSide - kReach),
                              0.25f * static_cast<float>(i / kSide - kReach), 1.0f);
    mesh.positions.push_back(eye + distance * turned(direction, axis));
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    const auto v = static_cast<std::uint32_t>(i);
    mesh.triangles.emplace_back(v, v + 1, v + kSide);
    mesh.triangles.emplace_back(v + 1, v + kSide + 1, v + kSide);
  }
  random.shuffle(mesh.triangles);
  const double length = random.between(1, 1 << 12);
  const auto step = [&](double x, double y, double z) { return turned(length * glm::dvec3(x, y, z), axis); };
  instance.camera =
      grid_camera(eye, step(-0.875, 0.875, 1.0), step(0.125, 0.0, 0.0), step(0.0, -0.125, 0.0), 15, 15);
}

constexpr Case kCases[] = {
    {kGroup, "shared-edge",
     "A bumpy sheet of 18 triangles and rays aimed exactly at points of their edges, a quarter, a half or "
     "three quarters along.",
     "A ray through an edge inside a surface hits exactly one of the two triangles that share it.", 1,
     shared_edge},
    {kGroup, "fan-vertex",
     "A fan of 3 to 12 triangles around a vertex and rays aimed exactly at it from either side.",
     "A ray through a vertex inside a surface hits exactly one of the triangles around it.", 1, fan_vertex},
    {kGroup, "along-edge",
     "A bumpy sheet and rays that run along the lines of its edges, from before, on or behind the edge.",
     "An origin on an edge's line gives that edge the sign zero: its triangles are missed, and what else is "
     "in "
     "the way is seen.",
     1, along_edge},
    {kGroup, "t-junction",
     "Two triangles that meet in the middle of another's edge, exactly or a float or two beside it, and rays "
     "aimed at that edge.",
     "Edges on one line decide alike, so an exact joint has no crack; one that is a float off has a crack or "
     "an overlap of that width, which is seen as it is.",
     1, t_junction},
    {kGroup, "non-manifold-fan",
     "Between 3 and 9 triangles that share one edge, and rays aimed exactly at that edge.",
     "Each triangle is decided by the same sign of the shared edge, as if the ray passed a little beside it.",
     1, non_manifold_fan},
    {kGroup, "edge-pixels",
     "A bumpy sheet whose vertices lie exactly on the rays of pixels, so that every pixel of a frame looks "
     "through a vertex or the middle of an edge.",
     "Every pixel on the sheet sees exactly one of the triangles around it.", 3, edge_pixels},
};

}  // namespace

std::span<const Case> edge_cases() { return kCases; }

}  // namespace plumb::cases
