#include <utility>

#include "cases/groups.h"
#include "cases/shape.h"
#include "plumb/builtin.h"
#include "support/hard_cameras.h"
#include "support/hard_scenes.h"

// What is hard on trees and tiles rather than on arithmetic.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Trees and tiles";
constexpr int kRays = 8;

void look_at_it(Random& random, Instance& instance) {
  aim(random, instance, kRays, {"at_vertex", "at_edge", "at_inside", "anywhere"});
  instance.camera = hard::camera_of_kind(random, instance.mesh, "outside");
}

void equal_centroids(Random& random, Instance& instance) {
  instance.mesh = hard::scene_of_kind(random, "concentric");
  look_at_it(random, instance);
}

// On each axis one vertex lies at -1, another at 1 and the third between.
void equal_boxes(Random& random, Instance& instance) {
  for (int i = 0; i < 20; ++i) {
    glm::vec3 v[3] = {fixed3(random), fixed3(random), fixed3(random)};
    for (int axis = 0; axis < 3; ++axis) {
      const int low = random.between(0, 2), high = (low + random.between(1, 2)) % 3;
      v[low][axis] = -1.0f;
      v[high][axis] = 1.0f;
    }
    add(instance.mesh, v[0], v[1], v[2]);
  }
  look_at_it(random, instance);
}

void stadium(Random& random, Instance& instance) {
  static const BuiltinScene scene = builtin_scene("teapot-in-stadium:2000");
  instance.mesh = scene.mesh;
  for (int i = 0; i < 32; ++i) {
    const glm::vec3 origin = scene.eye + fixed3(random);
    const glm::vec3 point = on_some_edge(random, instance.mesh);
    instance.rays.push_back(make_ray(origin, point - origin));
  }
  const glm::vec3 eye = scene.eye + fixed3(random);
  instance.camera = narrow_camera(eye, scene.target, random.one_in(2) ? 0.25 : 0.01);
}

void count(Random& random, Instance& instance, int triangles) {
  for (int i = 0; i < triangles; ++i) {
    const glm::vec3 v0 = random.lattice3(3), v1 = random.lattice3(3), v2 = random.lattice3(3);
    add(instance.mesh, v0, v1, v2);
  }
  look_at_it(random, instance);
}

void no_triangle(Random& random, Instance& instance) { count(random, instance, 0); }
void one_triangle(Random& random, Instance& instance) { count(random, instance, 1); }
void two_triangles(Random& random, Instance& instance) { count(random, instance, 2); }

constexpr std::string_view kTreesDoNotMatter =
    "The answer is a minimum over all triangles: how a tree divides them changes nothing.";

constexpr Case kCases[] = {
    {kGroup, "equal-centroids", "16 triangles with one centroid, their boxes nested or crossing.",
     kTreesDoNotMatter, 6, equal_centroids},
    {kGroup, "equal-boxes", "20 triangles whose bounding boxes are all the same cube.", kTreesDoNotMatter, 6,
     equal_boxes},
    {kGroup, "teapot-in-stadium",
     "The built-in scene of 2000 triangles, the teapot a thousandth of the stadium's length, with rays aimed "
     "at points of edges and frames of all of it or of the teapot.",
     kTreesDoNotMatter, 10, stadium},
    {kGroup, "no-triangle", "A scene without triangles.", "Nothing is seen: t = +inf, id = 0xffffffff.", 4,
     no_triangle},
    {kGroup, "one-triangle", "A scene of one triangle.", "It is seen where it is.", 4, one_triangle},
    {kGroup, "two-triangles", "A scene of two triangles.", "The one with the smaller (t, id) is seen.", 4,
     two_triangles},
};

}  // namespace

std::span<const Case> tree_cases() { return kCases; }

}  // namespace plumb::cases
