#include "cases/groups.h"
#include "cases/shape.h"

// Rays through the edges and vertices of surfaces.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "edges and vertices";
constexpr int kRays = 8;

// A sheet of shared vertices over a grid, its corners jittered in all directions.
constexpr std::uint32_t kSide = 4;

TriangleMesh sheet(Random& random) {
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const glm::vec3 jitter = fixed3(random, -3);
    mesh.positions.push_back(0.5f * glm::vec3(i % kSide, i / kSide, 0.0f) - 0.75f * glm::vec3(1, 1, 0) +
                             jitter);
    if (i % kSide + 1 == kSide || i / kSide + 1 == kSide) continue;
    mesh.triangles.emplace_back(i, i + 1, i + kSide);
    mesh.triangles.emplace_back(i + 1, i + kSide + 1, i + kSide);
  }
  random.shuffle(mesh.triangles);
  return mesh;
}

// Above or below all of the sheet.
glm::vec3 off_the_sheet(Random& random) {
  glm::vec3 origin = fixed3(random);
  origin.z = random.one_in(2) ? 1.0f : -1.0f;
  return origin;
}

void shared_edge(Random& random, Instance& instance) {
  instance.mesh = sheet(random);
  for (int i = 0; i < kRays; ++i) {
    const glm::uvec3 triangle = random.pick(instance.mesh.triangles);
    const int corner = random.between(0, 2);
    const glm::vec3 point = between(random, instance.mesh.positions[triangle[corner]],
                                    instance.mesh.positions[triangle[(corner + 1) % 3]]);
    const glm::vec3 origin = off_the_sheet(random);
    instance.rays.push_back(towards(random, origin, point));
  }
}

constexpr Case kCases[] = {
    {kGroup, "shared-edge",
     "A bumpy sheet of 18 triangles and rays aimed exactly at points of their edges, a quarter, a half or "
     "three quarters along.",
     "A ray through an edge inside a surface hits exactly one of the two triangles that share it.", 1,
     shared_edge},
};

}  // namespace

std::span<const Case> edge_cases() { return kCases; }

}  // namespace plumb::cases
