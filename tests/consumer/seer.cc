#include "seer.h"

#include <plumb/plumb.h>

bool sees_the_same(const plumb::TriangleMesh& mesh) {
  const plumb::Camera camera = plumb::frame_all(mesh, 40, 30);
  plumb::Frame rays(40, 30), triangles(40, 30);
  plumb::cast(plumb::Bvh(mesh), camera, rays);
  plumb::rasterize(mesh, camera, triangles);
  const bool sees_something = rays.id != plumb::Frame(40, 30).id;
  return sees_something && plumb::compare(rays, triangles).equal();
}
