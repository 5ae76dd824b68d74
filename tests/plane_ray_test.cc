// A ray's bounds at planes and boxes against exact arithmetic.

#include "structures/plane_ray.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmpxx.h>

#include "support/effort.h"
#include "support/random.h"

using namespace plumb;
using plumb::detail::Box;
using plumb::detail::PlaneInterval;
using plumb::detail::PlaneRay;
using plumb::hard::Random;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Of any size that floats have, and often 0 or a power of two.
float any_float(Random& random) {
  const float sign = random.one_in(2) ? 1.0f : -1.0f;
  if (random.one_in(10)) return sign * 0.0f;
  if (random.one_in(10)) return sign * std::numeric_limits<float>::max();
  const int exponent = random.one_in(2) ? random.between(-4, 4) : random.between(-149, 126);
  return sign * std::ldexp(random.one_in(4) ? 1.0f : 1.0f + std::fabs(random.unit()), exponent);
}

float next_to(Random& random, float x) {
  return random.one_in(3) ? x : std::nextafter(x, random.one_in(2) ? kInfinity : -kInfinity);
}

bool is_finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

}  // namespace

TEST_SUITE("plane ray") {
  TEST_CASE("the bounds of t hold the exact one, of every size") {
    Random random(1);
    int ahead = 0, behind = 0, parallel = 0;
    for (int i = 0; i < hard::effort(300'000); ++i) {
      const int axis = random.between(0, 2);
      glm::vec3 origin(1.0f), direction(1.0f);
      origin[axis] = any_float(random);
      direction[axis] = any_float(random);
      const float plane = random.one_in(3) ? next_to(random, origin[axis]) : any_float(random);
      if (!std::isfinite(plane)) continue;
      const PlaneRay ray(Ray{origin, 0.0f, direction, kInfinity});
      const PlaneInterval t = ray.meet(axis, plane);
      const mpq_class difference = mpq_class(double{plane}) - mpq_class(double{origin[axis]});
      if (direction[axis] == 0.0f) {
        ++parallel;
        CHECK(ray.forward(axis));
        CHECK((sgn(difference) == 0 ? std::isnan(t.lo) && std::isnan(t.hi)
                                    : t.lo == t.hi && std::isinf(t.lo) && (t.lo > 0.0) == (difference > 0)));
        continue;
      }
      CHECK(ray.forward(axis) == (direction[axis] > 0.0f));
      const mpq_class exact = difference / mpq_class(double{direction[axis]});
      if (exact >= 0) {
        ++ahead;
        CHECK(mpq_class(t.lo) <= exact);
        CHECK(mpq_class(t.hi) >= exact);
        CHECK(t.hi - t.lo <= 0x1p-48 * t.hi);
      } else {
        ++behind;
        CHECK(t.lo < 0.0);
        CHECK(t.hi < 0.0);
      }
    }
    CHECK(ahead > hard::effort(50'000));
    CHECK(behind > hard::effort(50'000));
    CHECK(parallel > hard::effort(10'000));
  }

  TEST_CASE("a box that holds a point of the ray is met, at bounds that hold its t") {
    Random random(2);
    int touched = 0;
    for (int i = 0; i < hard::effort(100'000); ++i) {
      Ray ray;
      for (int axis = 0; axis < 3; ++axis) {
        ray.origin[axis] = any_float(random);
        ray.direction[axis] = any_float(random);
      }
      if (ray.direction == glm::vec3(0.0f)) continue;
      // Up to three faces are at the nearest floats around a point, the others anywhere beyond.
      const auto t = double{std::fabs(any_float(random))};
      Box box;
      bool holds = true;
      for (int axis = 0; axis < 3; ++axis) {
        const mpq_class x =
            mpq_class(double{ray.origin[axis]}) + mpq_class(t) * mpq_class(double{ray.direction[axis]});
        const auto at = static_cast<float>(x.get_d());
        const float lo = next_to(random, at), hi = next_to(random, at);
        const float out = random.one_in(2) ? std::fabs(any_float(random)) : 0.0f;
        const bool up = random.one_in(2);
        box.lo[axis] = std::min(lo, hi) - (up ? 0.0f : out);
        box.hi[axis] = std::max(lo, hi) + (up ? out : 0.0f);
        if (!std::isfinite(box.lo[axis]) || !std::isfinite(box.hi[axis])) {
          holds = false;
          break;
        }
        holds = holds && mpq_class(double{box.lo[axis]}) <= x && x <= mpq_class(double{box.hi[axis]});
      }
      if (!holds || !is_finite(ray.origin)) continue;
      ++touched;
      // The limit is a float that is not below t, as depth_limit() makes it.
      float limit = static_cast<float>(t);
      if (double{limit} < t) limit = std::nextafter(limit, kInfinity);
      if (random.one_in(2)) limit = kInfinity;
      double entry = -1.0, exit = -1.0;
      const bool met = PlaneRay(ray).meets(box, limit, entry, exit);
      CHECK(met);
      CHECK(entry >= 0.0);
      CHECK(entry <= t);
      CHECK(t <= exit);
    }
    CHECK(touched > hard::effort(5'000));
    MESSAGE(touched << " boxes touched");
  }

  TEST_CASE("boxes beside, behind and beyond are left out") {
    const PlaneRay ray(Ray{{0, 0, 0}, 1.0f, {1, 0, -0.0f}, 100.0f});
    double entry = 0.0, exit = 0.0;
    CHECK(ray.meets({{5, -1, -1}, {6, 1, 1}}, 100.0f, entry, exit));
    CHECK(entry > 4.999);
    CHECK(exit < 6.001);
    CHECK(ray.meets({{5, 0, 0}, {6, 1, 1}}, 100.0f, entry, exit));
    CHECK(ray.meets({{5, -1, -1}, {6, 0, 0}}, 100.0f, entry, exit));
    CHECK_FALSE(ray.meets({{5, 0.1f, -1}, {6, 1, 1}}, 100.0f, entry, exit));
    CHECK_FALSE(ray.meets({{5, -1, -1}, {6, 1, -0.1f}}, 100.0f, entry, exit));
    CHECK_FALSE(ray.meets({{-6, -1, -1}, {-5, 1, 1}}, 100.0f, entry, exit));
    CHECK_FALSE(ray.meets({{0.1f, -1, -1}, {0.9f, 1, 1}}, 100.0f, entry, exit));
    CHECK_FALSE(ray.meets({{5, -1, -1}, {6, 1, 1}}, 4.0f, entry, exit));
  }
}
