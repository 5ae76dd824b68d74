#include "plumb/sphere_tree.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

#include <gmpxx.h>

#include "build/box.h"
#include "plumb/builtin.h"
#include "plumb/bvh.h"
#include "structures/bounding_sphere.h"
#include "structures/sphere_ray.h"
#include "support/random.h"

using namespace plumb;
using plumb::detail::Box;
using plumb::detail::Sphere;
using plumb::hard::Random;

namespace {

mpq_class square_distance(const glm::vec3& p, const glm::vec3& q) {
  mpq_class sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const mpq_class d = mpq_class(double{p[axis]}) - mpq_class(double{q[axis]});
    sum += d * d;
  }
  return sum;
}

Box box_of(const TriangleMesh& mesh) {
  Box box = detail::empty_box();
  for (const glm::vec3& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      box.lo[axis] = std::min(box.lo[axis], p[axis]);
      box.hi[axis] = std::max(box.hi[axis], p[axis]);
    }
  }
  return box;
}

TriangleMesh random_triangles(Random& random, int count) {
  TriangleMesh mesh;
  const int scale = random.between(-140, 124);
  const glm::vec3 shift = random.one_in(2) ? random.unit3() * std::ldexp(1.0f, scale) : glm::vec3(0.0f);
  for (int i = 0; i < 3 * count; ++i) {
    mesh.positions.push_back(shift + random.unit3() * std::ldexp(1.0f, scale - random.between(0, 8)));
  }
  for (int i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(3 * i);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

}  // namespace

TEST_SUITE("spheres") {
  TEST_CASE("a bounding sphere holds every corner, exactly") {
    Random random(1);
    for (int i = 0; i < 300; ++i) {
      const TriangleMesh mesh = random_triangles(random, random.between(1, 40));
      std::vector<std::uint32_t> all(mesh.triangles.size());
      std::iota(all.begin(), all.end(), 0u);
      const Sphere sphere = detail::bounding_sphere(mesh, all, box_of(mesh));
      const mpq_class radius(double{sphere.radius});
      bool holds = true;
      for (const glm::vec3& p : mesh.positions)
        holds = holds && square_distance(p, sphere.center) <= radius * radius;
      CHECK(holds);
    }
  }

  TEST_CASE("the sphere of one point is that point, one that no float can measure is infinite") {
    const TriangleMesh point{{{3.0f, 4.0f, 5.0f}}, {{0, 0, 0}}};
    const std::uint32_t first[] = {0};
    const Sphere sphere = detail::bounding_sphere(point, first, box_of(point));
    CHECK(sphere.center == glm::vec3(3.0f, 4.0f, 5.0f));
    CHECK(sphere.radius == 0.0f);
    const TriangleMesh huge{{{-3e38f, -3e38f, -3e38f}, {3e38f, 3e38f, 3e38f}}, {{0, 1, 1}}};
    CHECK(detail::bounding_sphere(huge, first, box_of(huge)).radius ==
          std::numeric_limits<float>::infinity());
  }

  // The ray passes through a point of the sphere at t = 1 or a power of two: exactly touching, or within.
  TEST_CASE("a sphere that holds a point of the ray is met") {
    Random random(2);
    int touched = 0;
    for (int i = 0; i < 200'000; ++i) {
      const int scale = random.between(-100, 90);
      const int reach = random.between(0, 20);
      // Whole numbers, so that the point at t = 1 is exact: a sphere of radius 3 k around it less (k, 2 k, 2
      // k).
      const int k = random.between(1, 1000);
      const glm::vec3 offset = random.one_in(2) ? glm::vec3(k, 2 * k, -2 * k) : glm::vec3(0.0f, -3 * k, 0.0f);
      glm::vec3 direction, origin;
      for (int axis = 0; axis < 3; ++axis) {
        direction[axis] = static_cast<float>(random.between(-(1 << reach), 1 << reach));
        origin[axis] = static_cast<float>(random.between(-(1 << 20), 1 << 20));
      }
      if (random.one_in(3)) {  // a tangent in the plane that touches at the point
        direction = random.one_in(2) ? glm::vec3(2, -1, 0) : glm::vec3(0, 1, 1);
        if (offset.x == 0.0f) direction.y = 0.0f;
        direction *= static_cast<float>(1 << reach);
        ++touched;
      }
      if (direction == glm::vec3(0.0f)) continue;
      const glm::vec3 point = origin + direction;
      const float size = std::ldexp(1.0f, scale);
      const Ray ray{origin * size, 0.0f, direction * size, std::numeric_limits<float>::infinity()};
      const Sphere sphere{(point - offset) * size, 3.0f * static_cast<float>(k) * size};
      float near = -1.0f;
      const bool met = detail::SphereRay(ray).meets(sphere, 1.0f, near);
      CHECK(met);
      CHECK(near <= 1.0f);
      CHECK(near >= 0.0f);
    }
    CHECK(touched > 50'000);
  }

  TEST_CASE("spheres far off the line, behind the ray or beyond the limit are left out") {
    const detail::SphereRay ray(Ray{{0, 0, 0}, 1.0f, {1, 0, 0}, 100.0f});
    float near = 0.0f;
    CHECK(ray.meets({{5, 0, 0}, 1.0f}, 100.0f, near));
    CHECK(near > 3.999f);
    CHECK(near <= 4.0f);
    CHECK_FALSE(ray.meets({{5, 1.01f, 0}, 1.0f}, 100.0f, near));
    CHECK_FALSE(ray.meets({{-5, 0, 0}, 1.0f}, 100.0f, near));
    CHECK_FALSE(ray.meets({{0, 0, 0}, 0.99f}, 100.0f, near));
    CHECK_FALSE(ray.meets({{5, 0, 0}, 1.0f}, 3.9f, near));
  }

  TEST_CASE("it answers as the tree of boxes does, and is like it") {
    for (const char* name : {"terrain:2000", "teapot-in-stadium:4000", "soup:3000", "ties"}) {
      CAPTURE(name);
      const BuiltinScene scene = builtin_scene(name);
      const SphereTree spheres(scene.mesh, {.first_id = 7});
      BuildOptions options;
      options.width = 2;
      options.first_id = 7;
      const Bvh boxes(scene.mesh, options);
      Random random(3);
      std::vector<Ray> rays;
      for (int i = 0; i < 3000; ++i) {
        const Camera camera = scene.camera(320, 200);
        rays.push_back(camera.ray(random.between(0, 319), random.between(0, 199)));
        if (i % 2 == 0) rays.back().direction = random.unit3();
      }
      std::vector<Hit> expected(rays.size()), hits(rays.size());
      boxes.closest(rays, expected);
      spheres.closest(rays, hits);
      CHECK(hits == expected);
      const TestCounts counts = spheres.count_tests(rays), with_boxes = boxes.count_tests(rays);
      CHECK(counts.rays == rays.size());
      // Spheres hold triangles worse than boxes do.
      CHECK(counts.volumes > with_boxes.volumes);
      const Statistics of_spheres = spheres.statistics(), of_boxes = boxes.statistics();
      CHECK(of_spheres.nodes == of_boxes.nodes);
      CHECK(of_spheres.leaves == of_boxes.leaves);
      CHECK(of_spheres.bytes < of_boxes.bytes);
      CHECK(of_spheres.triangles == scene.mesh.triangles.size());
    }
  }

  TEST_CASE("no triangle, one, and such as cannot be seen") {
    std::vector<Hit> hits;
    CHECK(SphereTree(TriangleMesh{}).closest(Ray{{0, 0, 0}, 0.0f, {1, 0, 0}}) == Hit{});
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const TriangleMesh mesh{{{1, -1, -1}, {1, 2, -1}, {1, -1, 2}, {nan, 0, 0}}, {{0, 1, 3}, {0, 1, 2}}};
    const SphereTree tree(mesh);
    CHECK(tree.closest(Ray{{0, 0, 0}, 0.0f, {1, 0, 0}}) == Hit{1.0f, 1});
    CHECK(tree.statistics().unseen_triangles == 1);
    CHECK(tree.statistics().references == 1);
  }
}
