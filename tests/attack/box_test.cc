// Attacks the float box test's factors (trace/box_ray.h): rays that touch a box in one point, exactly, so
// that the least error in the wrong direction loses the box. Each Highway target by itself.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/box_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "trace/box_ray.h"
#include "trace/box_test-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

std::uint32_t Boxes(const WideNode<4>& node, const BoxRay& ray, float limit, float* near) {
  return TestBoxes<4>(node, ray, limit, near);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "base/simd_dispatch.h"
#include "support/effort.h"
#include "support/random.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Boxes);

using hard::Random;

// A ray that enters one slab of the box at the very t = num / den at which it leaves another.
struct Touch {
  Ray ray;
  float lo[3], hi[3];
  int num, den;
};

// Integers, so that the ray is at num / den when it is at `point`, exactly. Either all have at most 24 bits,
// so that only the quotient is rounded; or the way from the origin to the point has 48, in no float.
Touch draw(Random& random) {
  Touch touch{};
  const bool is_long = random.one_in(2);
  touch.num = random.between(1, is_long ? (1 << 24) - 1 : 4095);
  touch.den = is_long ? 1 : random.between(1, 4095);
  const int enters = random.between(0, 2);
  const int leaves = (enters + random.between(1, 2)) % 3;
  for (int axis = 0; axis < 3; ++axis) {
    const int magnitude = random.between(1, is_long ? (1 << 24) - 1 : 2047);
    const std::int64_t x = random.one_in(2) ? magnitude : -magnitude;
    const std::int64_t way = touch.num * x;
    const std::int64_t origin = is_long ? -(way % (1 << 24)) : random.between(-(1 << 22), 1 << 22);
    const auto point = static_cast<float>(origin + way);
    touch.ray.origin[axis] = static_cast<float>(origin);
    touch.ray.direction[axis] = static_cast<float>(touch.den * x);
    const float beyond = std::ldexp(x > 0 ? 1.0f : -1.0f, random.between(1, 55));
    const float from = axis == enters ? point : point - beyond;
    const float to = axis == leaves ? point : point + beyond;
    touch.lo[axis] = std::min(from, to);
    touch.hi[axis] = std::max(from, to);
  }
  return touch;
}

WideNode<4> node_of(const Touch& touch) {
  WideNode<4> node{};
  for (int axis = 0; axis < 3; ++axis) {
    for (int i = 0; i < 4; ++i) {
      node.bounds[2 * axis][i] = i == 0 ? touch.lo[axis] : std::numeric_limits<float>::infinity();
      node.bounds[2 * axis + 1][i] = i == 0 ? touch.hi[axis] : -std::numeric_limits<float>::infinity();
    }
  }
  return node;
}

// The same touch with coordinates and the direction times powers of two: t changes by one of them.
Touch scaled(const Touch& touch, int coordinates, int direction) {
  Touch result = touch;
  for (int axis = 0; axis < 3; ++axis) {
    for (float* value : {&result.ray.origin[axis], &result.lo[axis], &result.hi[axis]})
      *value = std::ldexp(*value, coordinates);
    result.ray.direction[axis] = std::ldexp(result.ray.direction[axis], direction);
  }
  return result;
}

// Whether scaling lost nothing: subnormal numbers have fewer bits.
bool is_exact(const Touch& touch, const Touch& scaled_touch, int coordinates, int direction) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::ldexp(scaled_touch.ray.origin[axis], -coordinates) != touch.ray.origin[axis] ||
        std::ldexp(scaled_touch.lo[axis], -coordinates) != touch.lo[axis] ||
        std::ldexp(scaled_touch.hi[axis], -coordinates) != touch.hi[axis] ||
        std::ldexp(scaled_touch.ray.direction[axis], -direction) != touch.ray.direction[axis])
      return false;
  }
  return true;
}

// The test with factors 1 -+ slack 2^-24 in place of 1 -+ 6 2^-24, of an inverse that has been rounded.
bool is_met(Simd simd, const Touch& touch, double slack, float& near) {
  BoxRay ray(touch.ray, 0x1p56f);
  REQUIRE(ray.in_range);
  for (int axis = 0; axis < 3; ++axis) {
    const double inverse = double{1.0f / touch.ray.direction[axis]};
    ray.inv_near[axis] = static_cast<float>(inverse * (1.0 - slack * 0x1p-24));
    ray.inv_far[axis] = static_cast<float>(inverse * (1.0 + slack * 0x1p-24));
  }
  float all_near[4];
  const std::uint32_t met =
      PLUMB_DISPATCH(Boxes, simd)(node_of(touch), ray, std::numeric_limits<float>::infinity(), all_near);
  near = all_near[0];
  return (met & 1u) != 0;
}

}  // namespace

TEST_SUITE("attack: boxes") {
  TEST_CASE("a box that is touched in one point is met on every target, and not by luck") {
    for (const Simd simd : simd_targets()) {
      Random random(5);
      double most_slack = 0.0;
      int lost_without = 0;
      for (int i = 0; i < hard::effort(200'000); ++i) {
        const Touch touch = draw(random);
        float near = 0.0f;
        const bool met = is_met(simd, touch, 6.0, near);
        CHECK(met);
        // near is a lower bound: near * den <= num, both exact in double.
        CHECK(double{near} * touch.den <= touch.num);
        if (!met || is_met(simd, touch, 0.0, near)) continue;
        ++lost_without;
        double needed = 0.0;
        while (!is_met(simd, touch, needed, near)) needed += 0.125;
        most_slack = std::max(most_slack, needed);
      }
      MESSAGE(std::string(simd_name(simd))
              << ": of the slack of 6 units, a touched box needs at most " << most_slack << "; without any, "
              << lost_without << " boxes are lost");
      CHECK(most_slack <= 6.0);
      CHECK(most_slack > 0.8);
      CHECK(lost_without > 10'000 / static_cast<int>(hard::kEffortDivisor));
    }
  }

  TEST_CASE("a box that is touched in one point is met at the ends of the range, in float and in double") {
    for (const Simd simd : simd_targets()) {
      Random random(6);
      int in_float = 0, in_double = 0;
      for (int i = 0; i < hard::effort(200'000); ++i) {
        const Touch plain = draw(random);
        const int coordinates = random.one_in(2) ? random.between(-149, 4) : random.between(0, 6);
        const int direction = random.one_in(2) ? random.between(-149, 90) : random.between(30, 50);
        const Touch touch = scaled(plain, coordinates, direction);
        if (!is_exact(plain, touch, coordinates, direction)) continue;
        const double t = std::ldexp(double(plain.num) / plain.den, coordinates - direction);
        if (!(t > 0x1p-140 && t < 0x1p120)) continue;
        float greatest = 0.0f;
        for (int axis = 0; axis < 3; ++axis)
          greatest = std::max({greatest, std::fabs(touch.lo[axis]), std::fabs(touch.hi[axis])});
        float near[4] = {};
        const BoxRay ray(touch.ray, greatest);
        if (ray.in_range) {
          ++in_float;
          CHECK((PLUMB_DISPATCH(Boxes, simd)(node_of(touch), ray, std::numeric_limits<float>::infinity(),
                                             near) &
                 1u) != 0);
          CHECK(double{near[0]} <= t * (1.0 + 0x1p-50) + 0x1p-150);
        }
        ++in_double;
        float exact_near = 0.0f;
        CHECK(ExactBoxRay(touch.ray).meets(touch.lo, touch.hi, std::numeric_limits<float>::infinity(),
                                           exact_near));
        CHECK(double{exact_near} <= t * (1.0 + 0x1p-50) + 0x1p-150);
      }
      MESSAGE(std::string(simd_name(simd))
              << ": " << in_float << " boxes in float, " << in_double << " in double");
      CHECK(in_float > 5'000 / static_cast<int>(hard::kEffortDivisor));
      CHECK(in_double > 20'000 / static_cast<int>(hard::kEffortDivisor));
    }
  }
}

}  // namespace plumb::detail
#endif
