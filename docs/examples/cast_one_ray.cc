// What does this ray see? A mesh, a tree over it, one ray, and where the ray meets the surface.

#include <cstdio>

#include <plumb/plumb.h>

int main() {
  // A tent of two roof planes over the ground. A triangle's id is its index: 0 and 1 are the roof's
  // left side, 2 and 3 its right side.
  const plumb::TriangleMesh tent{
      {{-2, 0, 0}, {-2, 0, 4}, {0, 2, 0}, {0, 2, 4}, {2, 0, 0}, {2, 0, 4}},
      {{0, 1, 3}, {0, 3, 2}, {2, 3, 5}, {2, 5, 4}},
  };
  const plumb::Bvh bvh(tent);  // copies what it needs

  // Straight down at the right side. The direction may have any length: t counts in multiples of it.
  plumb::Ray ray;
  ray.origin = {1, 5, 1};
  ray.direction = {0, -2, 0};

  const plumb::Hit hit = bvh.closest(ray);
  if (hit.id == plumb::kNone) {
    std::printf("the ray sees nothing\n");
    return 1;
  }
  // What a hit does not say is made on demand, for shading and the like.
  const plumb::Surface surface = plumb::surface(tent, ray, hit);
  std::printf("triangle %u at t = %g: point (%g, %g, %g), normal (%g, %g, %g)\n",
              static_cast<unsigned>(hit.id), static_cast<double>(hit.t), static_cast<double>(surface.point.x),
              static_cast<double>(surface.point.y), static_cast<double>(surface.point.z),
              static_cast<double>(surface.normal.x), static_cast<double>(surface.normal.y),
              static_cast<double>(surface.normal.z));

  // A shadow ray only asks whether anything is there: none of the tent is above the point itself.
  ray.origin = surface.point;
  ray.direction = {0, 1, 0};
  const bool in_shadow = bvh.any(ray);

  // The roof is at height 1 here, which is 4 below the origin and so 2 directions away. Answers are
  // exact, so no tolerance is needed.
  const bool right = hit == plumb::Hit{2.0f, 3} && surface.point == glm::vec3(1, 1, 1) && !in_shadow;
  std::printf("%s\n", right ? "as it should be" : "WRONG");
  return right ? 0 : 1;
}
