#include "exact/intersect.h"

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "oracle/oracle.h"
#include "support/effort.h"
#include "support/hard_rays.h"
#include "support/oracle_adapter.h"
#include "support/random.h"

// The scalar arithmetic that everything ends in, against the oracle.

using namespace plumb;

namespace {

detail::Triangle triangle_of(const TriangleMesh& mesh, const glm::uvec3& corners) {
  return {mesh.positions[corners.x], mesh.positions[corners.y], mesh.positions[corners.z]};
}

oracle::Triangle to_oracle(const detail::Triangle& t) {
  return {witness::to_oracle(t.v0), witness::to_oracle(t.v1), witness::to_oracle(t.v2), 0};
}

// Calls `check(ray, triangle, where)` for every pair of a valid ray and a finite triangle.
template <typename Check>
std::size_t for_each_pair(const Check& check) {
  std::size_t pairs = 0;
  for (const hard::Case& c : hard::make_cases(hard::effort(40u), 24)) {
    for (std::size_t i = 0; i < c.rays.size(); ++i) {
      if (!detail::ray_is_valid(c.rays[i])) continue;
      const std::string where = c.describe(i);
      for (const glm::uvec3& corners : c.mesh.triangles) {
        const detail::Triangle triangle = triangle_of(c.mesh, corners);
        if (!detail::triangle_is_finite(triangle)) continue;
        check(c.rays[i], triangle, where);
        ++pairs;
      }
    }
  }
  return pairs;
}

// Whether a quotient, computed in double, lies halfway between two floats of ordinary size.
bool is_midpoint(double quotient) {
  return (std::bit_cast<std::uint64_t>(quotient) & 0x1fffffffu) == 0x10000000u;
}

}  // namespace

TEST_SUITE("exact") {
  TEST_CASE("a line hits what the oracle says, at its depth") {
    std::size_t ahead = 0, at_origin = 0, behind = 0, subnormal = 0;
    const std::size_t pairs =
        for_each_pair([&](const Ray& ray, const detail::Triangle& triangle, const std::string& where) {
          const std::optional<float> expected = oracle::line_hit(
              witness::to_oracle(ray.origin), witness::to_oracle(ray.direction), to_oracle(triangle));
          float t = -7.0f;
          const bool hit = detail::line_hit(ray.origin, ray.direction, triangle, t);
          // CHECK on every pair would cost more than the pair.
          if (hit != expected.has_value() || (hit && t != *expected)) {
            CAPTURE(where);
            REQUIRE(hit == expected.has_value());
            REQUIRE(t == *expected);
          }
          if (!hit) return;
          ++(t > 0.0f ? ahead : t < 0.0f ? behind : at_origin);
          subnormal += std::fpclassify(t) == FP_SUBNORMAL ? 1 : 0;
        });
    CHECK(pairs > hard::effort(std::size_t{200000}));
    CHECK(ahead > hard::effort(std::size_t{10000}));
    CHECK(behind > hard::effort(std::size_t{2000}));
    CHECK(at_origin > hard::effort(std::size_t{1000}));
    CHECK(subnormal > hard::effort(std::size_t{10}));
  }

  TEST_CASE("the depth of a line known to hit is the oracle's") {
    std::size_t finite = 0, infinite = 0;
    for_each_pair([&](const Ray& ray, const detail::Triangle& triangle, const std::string& where) {
      const oracle::Vec3 origin = witness::to_oracle(ray.origin),
                         direction = witness::to_oracle(ray.direction);
      if (!oracle::line_meets(origin, direction, to_oracle(triangle))) return;
      const std::optional<float> expected = oracle::plane_depth(origin, direction, to_oracle(triangle));
      if (!expected) return;
      CAPTURE(where);
      CHECK(detail::line_depth(ray.origin, ray.direction, triangle) == *expected);
      ++(std::isfinite(*expected) ? finite : infinite);
    });
    CHECK(finite > hard::effort(std::size_t{10000}));
    CHECK(infinite > hard::effort(std::size_t{100}));
  }

  TEST_CASE("depths at both ends of the floats' range round as all others") {
    constexpr float kMax = std::numeric_limits<float>::max();
    constexpr float kInf = std::numeric_limits<float>::infinity();
    struct Depth {
      float from, speed, to;  // along z
      float expected;
    };
    // The limit of infinity is 2^128 - 2^103; the greatest float is 2^128 - 2^104.
    const std::vector<Depth> depths = {
        {0, 1, kMax, kMax},
        {-0x1p102f, 1, kMax, kMax},
        {-0x1.fffffep102f, 1, kMax, kMax},
        {-0x1p103f, 1, kMax, kInf},
        {-0x1p103f, -1, kMax, -kInf},
        {-0x1.fffffep102f, -1, kMax, -kMax},
        {0, 0x1p-149f, 1, kInf},
        {0, 0x1p100f, 0x1p-49f, 0x1p-149f},
        {0, 0x1p100f, 0x1.8p-49f, 0x1p-148f},
        {0, 0x1p100f, 0x1.4p-48f, 0x1p-148f},
        {0, 0x1p100f, 0x1p-50f, 0},
        {0, 0x1p100f, 0x1.000002p-50f, 0x1p-149f},
        {0, 0x1p100f, 0x1.fffffep-27f, 0x1p-126f},
        {0, -0x1p100f, 0x1.8p-49f, -0x1p-148f},
    };
    for (const Depth& depth : depths) {
      CAPTURE(depth.from);
      CAPTURE(depth.speed);
      CAPTURE(depth.to);
      const glm::vec3 origin(0, 0, depth.from), direction(0, 0, depth.speed);
      const detail::Triangle triangle{{-1, -1, depth.to}, {3, -1, depth.to}, {-1, 3, depth.to}};
      float t = -7.0f;
      CHECK(detail::line_hit(origin, direction, triangle, t) == std::isfinite(depth.expected));
      if (std::isfinite(depth.expected)) CHECK(t == depth.expected);
      CHECK(detail::line_depth(origin, direction, triangle) == depth.expected);
    }
  }

  // Where t is (c - o) / d along an axis: ties are common there, at every magnitude.
  TEST_CASE("depths in planes across an axis are the oracle's, ties among them") {
    hard::Random random(5);
    std::size_t certain = 0, ties = 0, infinite = 0;
    for (int i = 0; i < hard::effort(40000); ++i) {
      const int axis = random.between(0, 2), scale = random.between(-100, 90);
      const auto coordinate = [&] { return std::ldexp(random.unit(), scale + random.between(-3, 3)); };
      // Few bits often, so that quotients are short.
      const auto rounded = [&](float f) { return random.one_in(2) ? f : std::round(f * 8.0f) / 8.0f; };
      const float plane = coordinate();
      detail::Triangle triangle{};
      for (glm::vec3* v : {&triangle.v0, &triangle.v1, &triangle.v2}) {
        *v = {coordinate(), coordinate(), coordinate()};
        (*v)[axis] = plane;
      }
      // Towards a point of it, or along the axis mostly.
      const glm::vec3 origin(coordinate(), coordinate(), coordinate());
      glm::vec3 direction = rounded(random.unit()) * random.unit3();
      direction[axis] = std::ldexp(rounded(random.unit()), random.one_in(8) ? random.between(-149, 100) : 0);
      if (random.one_in(3)) direction = {axis == 0, axis == 1, axis == 2};
      if (!detail::ray_is_valid(Ray{origin, 0.0f, direction, 1.0f})) continue;
      const oracle::Vec3 from = witness::to_oracle(origin), along = witness::to_oracle(direction);
      const std::optional<float> hit = oracle::line_hit(from, along, to_oracle(triangle));
      float t = -7.0f;
      REQUIRE(detail::line_hit(origin, direction, triangle, t) == hit.has_value());
      if (hit) CHECK(t == *hit);
      const std::optional<float> expected = oracle::plane_depth(from, along, to_oracle(triangle));
      if (!expected) continue;
      CHECK(detail::line_depth(origin, direction, triangle) == *expected);
      const double exact = (double{plane} - double{origin[axis]}) / double{direction[axis]};
      ++(std::isinf(*expected) ? infinite : is_midpoint(exact) ? ties : certain);
    }
    CHECK(certain > hard::effort(std::size_t{10000}));
    CHECK(ties > hard::effort(std::size_t{1000}));
    CHECK(infinite > 0);
  }

  TEST_CASE("rays and triangles are valid where the oracle says so") {
    std::size_t bad_rays = 0, bad_triangles = 0;
    for (const hard::Case& c : hard::make_cases(20, 24)) {
      for (std::size_t i = 0; i < c.rays.size(); ++i) {
        CAPTURE(c.describe(i));
        CHECK(detail::ray_is_valid(c.rays[i]) == oracle::can_see(witness::to_oracle(c.rays[i])));
        bad_rays += detail::ray_is_valid(c.rays[i]) ? 0 : 1;
      }
      for (const glm::uvec3& corners : c.mesh.triangles) {
        const detail::Triangle triangle = triangle_of(c.mesh, corners);
        CHECK(detail::triangle_is_finite(triangle) == oracle::can_be_seen(to_oracle(triangle)));
        bad_triangles += detail::triangle_is_finite(triangle) ? 0 : 1;
      }
    }
    CHECK(bad_rays > 500);
    CHECK(bad_triangles > 50);
  }
}
