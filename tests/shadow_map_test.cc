#include "plumb/shadow_map.h"

#include <doctest/doctest.h>

#include <cstddef>
#include <limits>

#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "plumb/camera.h"
#include "plumb/error.h"
#include "plumb/frame.h"

// Shadow maps against the exact answers of any().

using namespace plumb;

namespace {

// The point at t on the ray, rounded.
glm::vec3 point_at(const Ray& ray, float t) { return ray.origin + t * ray.direction; }

}  // namespace

TEST_SUITE("shadow map") {
  TEST_CASE("at its pixels' centres, in front of and behind what the light sees, the map is exact") {
    for (const char* name : {"cornell", "soup:2000", "spheres:2000"}) {
      CAPTURE(name);
      const BuiltinScene scene = builtin_scene(name);
      const Bvh bvh(scene.mesh);
      const Camera light = scene.camera(64, 48);
      const ShadowMap map(bvh, light);
      std::size_t lit = 0, dark = 0;
      for (int y = 0; y < light.height; ++y) {
        for (int x = 0; x < light.width; ++x) {
          const Ray ray = light.ray(x, y);
          const Hit hit = bvh.closest(ray);
          if (hit.id == kNone) continue;
          for (const float share : {0.5f, 0.999f, 1.001f, 1.5f}) {
            const glm::vec3 point = point_at(ray, hit.t * share);
            // The exact answer for the point on the ray, which the map is asked about by its rounded place.
            Ray before = ray;
            before.tmax = hit.t * share;
            CHECK(map.lit(point, 0.0f) == !bvh.any(before));
            (share < 1.0f ? lit : dark) += 1;
          }
          CHECK(map.lit(point_at(ray, hit.t), 1e-4f * hit.t));
        }
      }
      CHECK(lit > 100);
      CHECK(dark > 100);
    }
  }

  TEST_CASE("between the centres it is nearly so, and the nearer the more pixels it has") {
    const BuiltinScene scene = builtin_scene("spheres:5000");
    const Bvh bvh(scene.mesh);
    const Camera eye = scene.camera(100, 75);
    const glm::vec3 light_eye = scene.eye + glm::vec3(0.5f, 0.5f, 0.0f) * (scene.target - scene.eye).z;
    double last = 1.0;
    for (const int side : {64, 512}) {
      const Camera light = Camera::look_at(light_eye, scene.target, {0, 1, 0}, 50.0, side, side);
      const ShadowMap map(bvh, light);
      std::size_t asked = 0, wrong = 0;
      for (int y = 0; y < eye.height; ++y) {
        for (int x = 0; x < eye.width; ++x) {
          const Ray ray = eye.ray(x, y);
          const Hit hit = bvh.closest(ray);
          if (hit.id == kNone) continue;
          const glm::vec3 point = point_at(ray, hit.t);
          Ray shadow;
          shadow.origin = point;
          shadow.direction = light_eye - point;
          shadow.tmin = 1e-3f;
          shadow.tmax = 1.0f;
          ++asked;
          if (map.lit(point, 2e-2f) == bvh.any(shadow)) ++wrong;
        }
      }
      const double share = static_cast<double>(wrong) / static_cast<double>(asked);
      MESSAGE(side << " x " << side << ": " << wrong << " of " << asked << " points differ from any()");
      CHECK(asked > 500);
      CHECK(share < last);
      last = share;
    }
    CHECK(last < 0.1);
  }

  TEST_CASE("outside the light's frame, behind it and where nothing is a place, no point is lit") {
    const BuiltinScene scene = builtin_scene("cornell");
    const Camera light = Camera::look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 60.0, 16, 16);
    const ShadowMap map(light, Frame(16, 16));
    CHECK(map.lit({0, 0, -5}, 0.0f));
    CHECK(!map.lit({0, 0, 5}, 0.0f));
    CHECK(!map.lit({100, 0, -5}, 0.0f));
    CHECK(!map.lit({0, 0, 0}, 0.0f));
    CHECK(!map.lit({std::numeric_limits<float>::quiet_NaN(), 0, -5}, 0.0f));
    CHECK(!map.lit({0, 0, -std::numeric_limits<float>::infinity()}, 0.0f));
    CHECK_THROWS_AS(ShadowMap(light, Frame(16, 15)), Error);
    // A camera that looks nowhere.
    CHECK(!ShadowMap(Camera({0, 0, 0}, {0, 0, -1}, {0, 0, 0}, {0, 0, 0}, 4, 4), Frame(4, 4))
               .lit({0, 0, -1}, 0.0f));
    CHECK(!scene.mesh.triangles.empty());
  }
}
