#include <cmath>
#include <limits>
#include <utility>

#include <glm/vec2.hpp>

#include "cases/groups.h"
#include "cases/walls.h"

// Depths where rounding decides.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Depths";
constexpr int kRays = 8;

// A float from `least` up to `least` + 2^-2 with a mantissa of any bits.
float any_float(Random& random, float least) { return least + 0x1p-23f * float(random.below(1u << 21)); }

float up(float f) { return std::nextafter(f, std::numeric_limits<float>::infinity()); }

// Whether both heights over the speed round to one float; but for a double's own rounding.
bool ties(float a, float b, float speed) {
  return static_cast<float>(double{a} / double{speed}) == static_cast<float>(double{b} / double{speed});
}

// Two walls at heights next to each other whose depths round to one float.
void tie(Random& random, Instance& instance, bool lower_id_behind) {
  float near = 0.0f, speed = 0.0f;
  do {
    near = any_float(random, 1.5f);
    speed = any_float(random, 1.0f);
  } while (!ties(near, up(near), speed));
  Walls walls(random, instance, 0.0f, speed);
  walls.add_wall(lower_id_behind ? up(near) : near);
  walls.add_wall(lower_id_behind ? near : up(near));
  walls.add_rays(kRays);
  walls.add_camera();
}

void tie_behind(Random& random, Instance& instance) { tie(random, instance, true); }
void tie_in_front(Random& random, Instance& instance) { tie(random, instance, false); }

// Walls at 1 and at the next float, seen from -odd * 2^-24: 25 bits, the last one set, over a power of two.
void midpoint(Random& random, Instance& instance) {
  const float odd = static_cast<float>(2 * random.below(1u << 23) + 1);
  Walls walls(random, instance, -0x1p-24f * odd, std::ldexp(1.0f, random.between(-60, 60)));
  if (random.one_in(2)) walls.add_wall(up(1.0f));
  walls.add_wall(1.0f);
  if (random.one_in(2)) walls.add_wall(1.0f);
  walls.add_rays(kRays);
  walls.add_camera();
}

// The depth is (2^25 - 1 + j) 2^103, which rounds to infinity from j = 0 on.
void overflow(Random& random, Instance& instance) {
  const float unit = std::ldexp(1.0f, random.between(-20, 60));
  const float origin = -unit * static_cast<float>((1 << 24) - 1 + random.between(-2, 1));
  Walls walls(random, instance, origin, 0x1p-103f * unit, 0x1p25f * unit);
  walls.add_wall(0x1p24f * unit);
  walls.add_rays(kRays);
  walls.add_camera();
}

// The depth is a small number of halves or quarters of 2^-149.
void subnormal(Random& random, Instance& instance) {
  const float height = 0x1p-24f * static_cast<float>(random.between(0, 64));
  const float speed = std::ldexp(1.0f, random.between(125, 127));
  Walls walls(random, instance, 1.0f - height, speed);
  walls.add_wall(1.0f);
  if (random.one_in(2)) walls.add_wall(1.0f - 0x1p-24f);
  walls.add_rays(kRays);
  walls.add_camera();
}

// Two triangles of the same outline, each in front of the other at a corner by some floats.
void interpenetrating(Random& random, Instance& instance) {
  const int axis = random.between(0, 2);
  for (int pair = 0; pair < 3; ++pair) {
    const auto height = 1.0f + 0.25f * static_cast<float>(pair);
    const auto nudge = [&] { return 0x1p-22f * static_cast<float>(random.between(-8, 8)); };
    const glm::vec2 corners[] = {{-3, -2}, {3, -2}, {0, 4}};
    glm::vec3 a[3], b[3];
    for (int i = 0; i < 3; ++i) {
      const float dx = fixed(random), dy = fixed(random), slope = fixed(random, -4);
      a[i] = glm::vec3(height + slope, corners[i].x + dx, corners[i].y + dy);
      b[i] = a[i] + glm::vec3(nudge(), 0.0f, 0.0f);
      a[i] = turned(a[i], axis);
      b[i] = turned(b[i], axis);
    }
    add_turned(random, instance.mesh, a[0], a[1], a[2]);
    add_turned(random, instance.mesh, b[0], b[1], b[2]);
  }
  random.shuffle(instance.mesh.triangles);
  const glm::vec3 eye = 0.5f * coarse3(random);
  for (int i = 0; i < kRays; ++i) {
    const float dx = fixed(random, -1), dy = fixed(random, -1);
    instance.rays.push_back(make_ray(eye, turned(glm::vec3(1.0f, dx, dy), axis)));
  }
  instance.camera = narrow_camera(eye, eye + turned(glm::vec3(1, 0, 0), axis), 0.5);
}

// Walls and rays that begin or end exactly at the depth of one of them or a float before it.
template <typename Limit>
void limited(Random& random, Instance& instance, const Limit& limit) {
  constexpr int kWalls = 4;
  const float speed = any_float(random, 1.0f);
  Walls walls(random, instance, 0.0f, speed);
  float heights[kWalls];
  for (float& height : heights) {
    height = any_float(random, 1.0f);
    walls.add_wall(height);
  }
  walls.add_rays(kRays);
  for (Ray& ray : instance.rays) {
    const float t = static_cast<float>(double{heights[random.below(kWalls)]} / double{speed});
    limit(ray, random.one_in(2) ? t : std::nextafter(t, 0.0f));
  }
}

void tmin_at_hit(Random& random, Instance& instance) {
  limited(random, instance, [](Ray& ray, float t) { ray.tmin = t; });
}
void tmax_at_hit(Random& random, Instance& instance) {
  limited(random, instance, [](Ray& ray, float t) { ray.tmax = t; });
}

constexpr Case kCases[] = {
    {kGroup, "tie-lower-id-behind",
     "Two walls a float apart whose depths round to one float; the one behind has the lower id.",
     "Depths compare after rounding, and of equal ones the lower id is seen: the wall behind.", 4,
     tie_behind},
    {kGroup, "tie-lower-id-in-front",
     "Two walls a float apart whose depths round to one float; the one in front has the lower id.",
     "Depths compare after rounding, and of equal ones the lower id is seen: the wall in front.", 4,
     tie_in_front},
    {kGroup, "depth-midpoint", "Walls whose exact depth is the midpoint of two floats.",
     "The depth rounds once, to the even neighbour.", 4, midpoint},
    {kGroup, "depth-overflow",
     "Walls at a depth of exactly 2^128 - 2^103, or one or two 2^25ths of that off.",
     "A depth from 2^128 - 2^103 on rounds to infinity: a miss.", 4, overflow},
    {kGroup, "depth-subnormal", "Walls at depths of a few halves or quarters of 2^-149.",
     "A subnormal depth is returned as it is; one that rounds to zero does not count.", 4, subnormal},
    {kGroup, "interpenetrating",
     "Pairs of triangles of one outline, each up to 8 floats in front of the other at one of its corners.",
     "The nearer one after rounding is seen, and of equal ones the lower id.", 4, interpenetrating},
    {kGroup, "tmin-at-hit",
     "Walls and rays that begin exactly at the depth of one of them, or a float before.",
     "A hit at tmin does not count.", 1, tmin_at_hit},
    {kGroup, "tmax-at-hit", "Walls and rays that end exactly at the depth of one of them, or a float before.",
     "A hit at tmax counts.", 1, tmax_at_hit},
};

}  // namespace

std::span<const Case> depth_cases() { return kCases; }

}  // namespace plumb::cases
