#include <cstdio>
#include <fstream>

#include <plumb/plumb.h>

#include "seer.h"

namespace {

// A square of two triangles, from a file where the mesh readers are there.
plumb::TriangleMesh square() {
#ifdef CONSUMER_READS_MESHES
  std::ofstream("square.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  return plumb::load_mesh("square.obj");
#else
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
#endif
}

bool has_one_boundary(const plumb::TriangleMesh& mesh) {
#ifdef CONSUMER_READS_MESHES
  return plumb::topology(mesh).boundary_loops == 1;
#else
  return !mesh.triangles.empty();  // topology() is plumb::io's
#endif
}

}  // namespace

int main() {
  plumb::Ray ray;
  ray.origin = {0.75f, 0.5f, 2.0f};
  ray.direction = {0.0f, 0.0f, -1.0f};
  const plumb::Hit hit = plumb::Bvh(square()).closest(ray);
  const bool right = hit == plumb::Hit{2.0f, 0} && sees_the_same(square()) && has_one_boundary(square());
  std::printf("plumb %s: %s\n", PLUMB_VERSION, right ? "linked and right" : "WRONG");
  return right ? 0 : 1;
}
