#include <cmath>
#include <vector>

#include "cases/groups.h"
#include "cases/shape.h"
#include "support/hard_scenes.h"

// Triangles that are hardly there.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Slivers and specks";
constexpr int kRays = 8;

// A point beside the middle of an edge of length 1 to 3, by 2^-12 to 2^-22, is the third vertex.
void sliver(Random& random, Instance& instance) {
  constexpr int kSlivers = 8;
  struct Sliver {
    glm::vec3 middle, tip;
  };
  std::vector<Sliver> slivers;
  for (int i = 0; i < kSlivers; ++i) {
    const int axis = random.between(0, 2);
    glm::vec3 a = fixed3(random), b = fixed3(random);
    a.x = fixed(random, -2) - 0.75f;
    b.x = fixed(random, -2) + 0.75f;
    a = turned(a, axis);
    b = turned(b, axis);
    const glm::vec3 middle = between(random, a, b);
    glm::vec3 offset = random.lattice3(1);
    if (offset == glm::vec3(0.0f)) offset.x = 1.0f;
    const glm::vec3 tip = middle + std::ldexp(1.0f, -random.between(12, 22)) * offset;
    add_turned(random, instance.mesh, a, b, tip);
    slivers.push_back({middle, tip});
  }
  // At the tip, at half its height, or one float beside these.
  for (int i = 0; i < kRays; ++i) {
    const Sliver& target = random.pick(slivers);
    const glm::vec3 origin = fixed3(random);
    const glm::vec3 point = random.one_in(3) ? target.tip : 0.5f * target.middle + 0.5f * target.tip;
    Ray ray = towards(random, origin, point);
    if (random.one_in(2)) ray.direction = hard::nudged(random, ray.direction, 1);
    instance.rays.push_back(ray);
  }
}

// Directions of a frame of 24 x 16 pixels about an axis: pixel (x, y) at (x, y) / 32 in the plane at 1.
constexpr int kWidth = 24, kHeight = 16;

glm::vec3 pixel_direction(int x, int y, int axis) {
  return turned(0.03125f * glm::vec3(x - kWidth / 2, kHeight / 2 - y, 32), axis);
}

Camera pixel_camera(glm::vec3 eye, int axis) {
  const glm::dvec3 first(pixel_direction(0, 0, axis));
  return grid_camera(eye, first, glm::dvec3(pixel_direction(1, 0, axis)) - first,
                     glm::dvec3(pixel_direction(0, 1, axis)) - first, kWidth, kHeight);
}

// Triangles a thousandth of a pixel wide, half of them around the exact centre of a pixel.
void speck(Random& random, Instance& instance) {
  constexpr int kSpecks = 64, kSize = 16;
  const glm::vec3 eye = coarse3(random);
  const int axis = random.between(0, 2);
  for (int i = 0; i < kSpecks; ++i) {
    const int x = random.between(0, kWidth - 1), y = random.between(0, kHeight - 1);
    const float distance = static_cast<float>(random.between(1, 3));
    const glm::vec3 p = random.lattice3(kSize), q = random.lattice3(kSize);
    glm::vec3 beside = random.lattice3(8 * kSize);
    if (random.one_in(2)) beside = glm::vec3(0.0f);
    const glm::vec3 centre = eye + distance * pixel_direction(x, y, axis) + 0x1p-20f * beside;
    add_turned(random, instance.mesh, centre + 0x1p-20f * p, centre + 0x1p-20f * q,
               centre - 0x1p-20f * (p + q));
  }
  instance.camera = pixel_camera(eye, axis);
}

// Strips between the rays of two pixels, far apart in depth, so thin that only pixels whose centres lie
// exactly between the two see them.
void thin_diagonal(Random& random, Instance& instance) {
  constexpr int kStrips = 8;
  const glm::vec3 eye = coarse3(random);
  const int axis = random.between(0, 2);
  const auto end = [&](int x, int y) {
    return eye + static_cast<float>(random.between(1, 4)) * pixel_direction(x, y, axis);
  };
  for (int i = 0; i < kStrips; ++i) {
    const int x = random.between(0, kWidth - 1), y = random.between(0, kHeight - 1);
    const int step_x = random.between(-2, 2), step_y = random.between(1, 2);
    const glm::vec3 a = end(x - 8 * step_x, y - 8 * step_y);
    const glm::vec3 b = end(x + 8 * step_x, y + 8 * step_y);
    const float width = std::ldexp(1.0f, -random.between(11, 20));
    const glm::vec3 wide = width * random.lattice3(2);
    // The diagonal, or one long edge, or the middle of one of both triangles on the line of pixels.
    const glm::vec3 a0 = random.one_in(2) ? a : a - wide, b0 = random.one_in(2) ? b : b - wide;
    add_turned(random, instance.mesh, a0, b0, b0 + 2.0f * wide);
    add_turned(random, instance.mesh, a0, b0 + 2.0f * wide, a0 + 2.0f * wide);
  }
  instance.camera = pixel_camera(eye, axis);
}

void zero_area(Random& random, Instance& instance) {
  TriangleMesh& mesh = instance.mesh;
  for (int i = 0; i < 12; ++i) {
    const glm::vec3 v0 = random.lattice3(3), v1 = random.lattice3(3);
    const glm::vec3 v2 = v0 + static_cast<float>(random.between(-1, 2)) * (v1 - v0);
    add_turned(random, mesh, v0, v1, v2);
  }
  // Something to be seen behind them.
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 v0 = random.lattice3(6), v1 = random.lattice3(6), v2 = random.lattice3(6);
    add_turned(random, mesh, v0, v1, v2);
  }
  random.shuffle(mesh.triangles);
  aim(random, instance, kRays, {"at_edge", "at_vertex", "at_inside"});
  instance.camera = lattice_camera(random);
}

void point(Random& random, Instance& instance) {
  TriangleMesh& mesh = instance.mesh;
  for (int i = 0; i < 16; ++i) {
    const glm::vec3 v = random.lattice3(3);
    add(mesh, v, v, v);
  }
  for (int i = 0; i < 3; ++i) {
    const glm::vec3 v0 = random.lattice3(6), v1 = random.lattice3(6), v2 = random.lattice3(6);
    add_turned(random, mesh, v0, v1, v2);
  }
  random.shuffle(mesh.triangles);
  aim(random, instance, kRays, {"at_vertex"});
  instance.camera = lattice_camera(random);
}

constexpr Case kCases[] = {
    {kGroup, "sliver",
     "Triangles up to 10^7 times as long as they are high, and rays aimed exactly at their tip or at half "
     "their height, or a float beside.",
     "A sliver is a triangle: it is hit where the exact edge functions say so.", 1, sliver},
    {kGroup, "speck",
     "Triangles a thousandth of a pixel wide, half of them around the exact centre of a pixel.",
     "A pixel sees a triangle, however small, whose inside its ray meets, and no other.", 3, speck},
    {kGroup, "thin-diagonal",
     "Strips across the frame, 2000 to 10^6 times as long as they are wide, on lines through the centres of "
     "pixels.",
     "A pixel sees a strip where its ray meets the inside or, by the displacement, one side of an edge.", 3,
     thin_diagonal},
    {kGroup, "zero-area", "Triangles whose vertices lie on one line, and rays and pixels aimed at them.",
     "The normal of such a triangle is zero and with it the depth's denominator: it is never seen.", 6,
     zero_area},
    {kGroup, "point",
     "Triangles whose three vertices are one point, and rays and pixels aimed exactly at it.",
     "Its edges and its normal are zero: it is never seen.", 6, point},
};

}  // namespace

std::span<const Case> shape_cases() { return kCases; }

}  // namespace plumb::cases
