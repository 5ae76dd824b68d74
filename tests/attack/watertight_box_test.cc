// Attacks the slack of the watertight arithmetic's boxes (trace/watertight_ray.h): rays that pass a triangle
// by, so closely that its rounded vertices are met, while its box is not. Each Highway target by itself.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/watertight_box_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "trace/box_test-inl.h"
#include "trace/watertight_ray.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

std::uint32_t WatertightBoxes(const WideNode<4>& node, const WatertightRay& ray, float* near) {
  return TestBoxes<4>(node, ray, std::numeric_limits<float>::infinity(), near);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/simd_dispatch.h"
#include "support/effort.h"
#include "support/random.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(WatertightBoxes);

using hard::Random;

struct Pass {
  Triangle triangle;
  Ray ray;
};

// A triangle with an edge along an edge of its box, from far behind the ray's origin to far ahead, and a ray
// that touches the box in one point of it nearby. The ends are rounded by what is far, the box test by what
// is near.
Pass draw(Random& random) {
  const int x = random.between(0, 2);
  const int y = (x + random.between(1, 2)) % 3;
  const int z = 3 - x - y;
  Pass pass{};
  pass.ray.origin = random.unit3();
  const glm::vec3 o = pass.ray.origin;
  glm::vec3 point = o + random.unit3() * 0.125f;
  for (const int axis : {x, y}) point[axis] += random.one_in(2) ? 0.875f : -0.875f;
  point[z] = o[z] + (random.one_in(2) ? 1.0f : -1.0f);
  const glm::vec3 way = point - o;
  const auto length = [&] { return (1.5f + 0.5f * random.unit()) * std::ldexp(1.0f, random.between(0, 10)); };
  glm::vec3 a = point, b = point, c = point;
  a[z] = o[z] - length();
  b[z] = o[z] + length();
  // The ray enters the box through the face across x where it leaves it through the one across y.
  c[x] += way[x] > 0.0f ? 8.0f : -8.0f;
  c[y] -= way[y] > 0.0f ? 8.0f : -8.0f;
  pass.ray.direction = way * (1.0f + 0.25f * random.unit());
  pass.ray.direction[x] *= 1.0f + random.unit() * std::ldexp(1.0f, random.between(-24, -14));
  pass.triangle = {a, b, c};
  return pass;
}

Box box_of(const Triangle& t) {
  Box box{};
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min({t.v0[axis], t.v1[axis], t.v2[axis]});
    box.hi[axis] = std::max({t.v0[axis], t.v1[axis], t.v2[axis]});
  }
  return box;
}

bool is_met(Simd simd, WatertightRay ray, const Box& box, const glm::vec3& origin, float slack, float& near) {
  WideNode<4> node{};
  for (int axis = 0; axis < 3; ++axis) {
    std::fill_n(node.bounds[2 * axis], 4, box.lo[axis]);
    std::fill_n(node.bounds[2 * axis + 1], 4, box.hi[axis]);
    // The origins of the planes with a share of the slack.
    const auto shrink = [&](float& o) { o = origin[axis] + (o - origin[axis]) * slack; };
    shrink(ray.box_origin_near[axis]);
    shrink(ray.box_origin_far[axis]);
  }
  float all_near[4];
  const bool met = PLUMB_DISPATCH(WatertightBoxes, simd)(node, ray, all_near) != 0;
  near = all_near[0];
  return met;
}

}  // namespace

TEST_SUITE("attack: watertight boxes") {
  TEST_CASE("the box of a triangle that is met is met on every target, and not by luck") {
    for (const Simd simd : simd_targets()) {
      Random random(11);
      int met_count = 0, lost_without = 0;
      float most_slack = 0.0f;
      for (int i = 0; i < hard::effort(400'000); ++i) {
        const Pass pass = draw(random);
        const Box box = box_of(pass.triangle);
        const WatertightRay ray(pass.ray, box, 2048.0f);
        REQUIRE(ray.in_range);
        float t = 0.0f;
        if (!watertight_hit(ray, pass.triangle, t) || !(t > 0.0f)) continue;
        ++met_count;
        float near = 0.0f;
        CHECK(is_met(simd, ray, box, pass.ray.origin, 1.0f, near));
        if (is_met(simd, ray, box, pass.ray.origin, 0.0f, near)) continue;
        ++lost_without;
        float needed = 0.0f;
        while (needed < 1.0f && !is_met(simd, ray, box, pass.ray.origin, needed, near)) needed += 0.03125f;
        most_slack = std::max(most_slack, needed);
      }
      MESSAGE(std::string(simd_name(simd))
              << ": of " << met_count << " boxes " << lost_without << " are lost without the slack; "
              << most_slack << " of it is the most that one needs");
      CHECK(most_slack < 1.0f);
      CHECK(most_slack > 0.05f);
      CHECK(lost_without > 100 / static_cast<int>(hard::kEffortDivisor));
    }
  }
}

}  // namespace plumb::detail
#endif
