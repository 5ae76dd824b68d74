#include "plumb/surface.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gmpxx.h>

#include "oracle/exact.h"
#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "support/fp_modes.h"
#include "support/hard_rays.h"

// What surface() says of a hit, against integers and rationals of any length.

using namespace plumb;

namespace {

using Integers = std::array<mpz_class, 3>;

Integers scaled(const glm::vec3& v) {
  return {oracle::scaled(v.x), oracle::scaled(v.y), oracle::scaled(v.z)};
}

Integers minus(const Integers& p, const Integers& q) { return {p[0] - q[0], p[1] - q[1], p[2] - q[2]}; }

Integers cross(const Integers& p, const Integers& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}

mpz_class dot(const Integers& p, const Integers& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }

mpq_class ratio(const mpz_class& numerator, const mpz_class& denominator) {
  mpq_class result(numerator, denominator);
  result.canonicalize();
  return result;
}

// From a float to the next one, away from 0.
mpq_class last_place(float f) {
  const float magnitude = std::fabs(f);
  const float next = std::nextafter(magnitude, std::numeric_limits<float>::infinity());
  if (std::isinf(next)) return mpq_class(0x1p104);
  return mpq_class(double{next}) - mpq_class(double{magnitude});
}

struct Corners {
  glm::vec3 v0, v1, v2;
};

Corners corners_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const glm::uvec3& c = mesh.triangles[triangle];
  return {mesh.positions[c.x], mesh.positions[c.y], mesh.positions[c.z]};
}

// All that the header promises of the weights, and of the point, which is taken from the ray here:
// origin + det(a, b, c) / (E0 + E1 + E2) * direction.
bool weights_and_point_hold(const Corners& tri, const Ray& ray, const Surface& s) {
  const Integers o = scaled(ray.origin), d = scaled(ray.direction);
  const Integers a = minus(scaled(tri.v0), o), b = minus(scaled(tri.v1), o), c = minus(scaled(tri.v2), o);
  const Integers b_cross_c = cross(b, c);
  const mpz_class e0 = dot(d, cross(a, b)), e1 = dot(d, b_cross_c), e2 = dot(d, cross(c, a));
  const mpz_class sum = e0 + e1 + e2;
  bool hold = abs(mpq_class(double{s.u}) - ratio(e2, sum)) < last_place(s.u) &&
              abs(mpq_class(double{s.v}) - ratio(e0, sum)) < last_place(s.v);
  hold = hold && s.u >= 0.0f && s.v >= 0.0f && !std::signbit(s.u) && !std::signbit(s.v) &&
         double{s.u} + double{s.v} <= 1.0 + 0x1p-23;

  // In units of 2^-149, as all integers here are; the greatest difference on an axis is no more than the
  // longest edge.
  mpz_class longest = 0;
  for (const Integers& edge : {minus(b, a), minus(c, a), minus(c, b)}) {
    for (const mpz_class& component : edge) longest = std::max<mpz_class>(longest, abs(component));
  }
  const mpq_class t = ratio(dot(a, b_cross_c), sum);
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const mpq_class exact = o[k] + t * d[k];
    const mpq_class half_place = last_place(s.point[axis]) * oracle::scaled(1.0f) / 2;
    const mpq_class off = abs(oracle::scaled(s.point[axis]) - exact);
    hold = hold && off <= half_place + longest * mpq_class(0x1p-30);
    hold = hold && s.point[axis] >= std::min({tri.v0[axis], tri.v1[axis], tri.v2[axis]}) &&
           s.point[axis] <= std::max({tri.v0[axis], tri.v1[axis], tri.v2[axis]});
  }
  return hold;
}

bool normal_holds(const Corners& tri, const Surface& s) {
  constexpr mp_bitcnt_t kBits = 512;
  const Integers n = cross(minus(scaled(tri.v1), scaled(tri.v0)), minus(scaled(tri.v2), scaled(tri.v0)));
  const mpf_class length = sqrt(mpf_class(dot(n, n), kBits));
  mpf_class square(0, kBits);
  bool hold = true;
  for (int axis = 0; axis < 3; ++axis) {
    const mpf_class exact = mpf_class(n[static_cast<std::size_t>(axis)], kBits) / length;
    const mpf_class given(double{s.normal[axis]}, kBits);
    hold = hold && abs(given - exact) < 0x1p-24;
    square += given * given;
  }
  return hold && abs(sqrt(square) - 1) < 0x1p-23;
}

// Checks every hit of every ray; returns how many there were.
std::size_t check_all_hits(const TriangleMesh& mesh, const std::vector<Ray>& rays) {
  const BruteForce brute(mesh);
  std::size_t count = 0;
  std::vector<Hit> hits;
  for (const Ray& ray : rays) {
    brute.all(ray, hits);
    for (const Hit& hit : hits) {
      const Corners tri = corners_of(mesh, hit.id);
      const Surface s = surface(mesh, ray, hit);
      CAPTURE(count);
      CAPTURE(hit.id);
      // CHECK on every hit would cost more than the hit.
      if (!weights_and_point_hold(tri, ray, s)) FAIL_CHECK("the weights or the point are off");
      if (!normal_holds(tri, s)) FAIL_CHECK("the normal is off");
    }
    count += hits.size();
  }
  return count;
}

TriangleMesh one_triangle(const Corners& c) { return {{c.v0, c.v1, c.v2}, {{0, 1, 2}}}; }

std::string message_of(const TriangleMesh& mesh, const Ray& ray, const Hit& hit, std::uint32_t first_id = 0) {
  try {
    surface(mesh, ray, hit, first_id);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

Ray ray_of(const glm::vec3& origin, const glm::vec3& direction) {
  Ray ray;
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

}  // namespace

TEST_SUITE("surface") {
  TEST_CASE("weights, point and normal are as exact as promised at every hit of every hard ray") {
    std::size_t hits = 0;
    for (const hard::Case& c : hard::make_cases(20, 48)) {
      CAPTURE(c.scene);
      CAPTURE(c.seed);
      hits += check_all_hits(c.mesh, c.rays);
    }
    CHECK(hits > 10000);
  }

  TEST_CASE("the scale makes no difference, from 1e-38 to 1e38") {
    hard::Random random(1);
    std::size_t hits = 0;
    for (int exponent = -38; exponent <= 38; ++exponent) {
      const auto scale = static_cast<float>(std::pow(10.0, exponent));
      CAPTURE(scale);
      for (int i = 0; i < 20; ++i) {
        const Corners c{scale * random.unit3(), scale * random.unit3(), scale * random.unit3()};
        const glm::vec3 origin = scale * random.unit3();
        const glm::vec3 middle = (0.25f * c.v0 + 0.25f * c.v1) + 0.5f * c.v2;
        hits += check_all_hits(one_triangle(c), {ray_of(origin, middle - origin)});
      }
    }
    CHECK(hits > 77 * 19);
  }

  TEST_CASE("a far origin makes no difference, nor does a thin triangle") {
    hard::Random random(2);
    std::size_t hits = 0;
    for (int distance = 0; distance <= 100; ++distance) {
      CAPTURE(distance);
      for (const float width : {1.0f, 1e-3f, 1e-6f}) {
        for (int i = 0; i < 20; ++i) {
          // Thin along a slanted line, about the origin, where floats are fine enough to hit it.
          const glm::vec3 along = random.unit3();
          const Corners c{-along, along + width * random.unit3(), width * random.unit3()};
          const glm::vec3 inside = 0.5f * c.v2 + 0.25f * (c.v0 + c.v1);
          const glm::vec3 origin = std::ldexp(1.0f, distance) * random.unit3();
          hits += check_all_hits(one_triangle(c), {ray_of(origin, inside - origin), ray_of(origin, -origin)});
        }
      }
    }
    CHECK(hits > 1000);
  }

  TEST_CASE("the weights name the vertices, and the normal is that of a counter-clockwise triangle") {
    const TriangleMesh mesh = one_triangle({{0, 0, -2}, {4, 0, -2}, {0, 8, -2}});
    const Ray ray = ray_of({1, 4, 0}, {0, 0, -1});
    const Surface s = surface(mesh, ray, BruteForce(mesh).closest(ray));
    CHECK(s.u == 0.25f);
    CHECK(s.v == 0.5f);
    CHECK(s.point == glm::vec3(1, 4, -2));
    CHECK(s.normal == glm::vec3(0, 0, 1));

    // Seen from behind, or turned over, or as a part of a scene.
    const Ray behind = ray_of({1, 4, -4}, {0, 0, 0.5f});
    CHECK(surface(mesh, behind, BruteForce(mesh).closest(behind)).normal == glm::vec3(0, 0, 1));
    const TriangleMesh turned{mesh.positions, {{0, 2, 1}}};
    const Surface other = surface(turned, ray, BruteForce(turned).closest(ray));
    CHECK(other.u == 0.5f);
    CHECK(other.v == 0.25f);
    CHECK(other.normal == glm::vec3(0, 0, -1));
    const Surface part = surface(mesh, ray, BruteForce(mesh, 1000).closest(ray), 1000);
    CHECK(part.point == s.point);
  }

  TEST_CASE("a ray through a vertex or an edge finds it") {
    const TriangleMesh mesh = one_triangle({{-1, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    const Hit hit{1.0f, 0};
    for (int i = 0; i < 3; ++i) {
      const Surface s = surface(mesh, ray_of({0, 0, 0}, mesh.positions[static_cast<std::size_t>(i)]), hit);
      CHECK(s.u == (i == 1 ? 1.0f : 0.0f));
      CHECK(s.v == (i == 2 ? 1.0f : 0.0f));
      CHECK(s.point == mesh.positions[static_cast<std::size_t>(i)]);
    }
    const Surface edge = surface(mesh, ray_of({0, 0, 0}, {0, 0, 1}), hit);
    CHECK(edge.u == 0.5f);
    CHECK(edge.v == 0.0f);
    CHECK(edge.point == glm::vec3(0, 0, 1));
  }

  TEST_CASE("the caller's floating-point mode changes nothing and is kept") {
    std::size_t hits_seen = 0;
    for (const hard::Case& c : hard::make_cases(2, 48)) {
      const BruteForce brute(c.mesh);
      std::vector<Hit> hits;
      for (const Ray& ray : c.rays) {
        brute.all(ray, hits);
        for (const Hit& hit : hits) {
          const Surface s = surface(c.mesh, ray, hit);
          const Surface other =
              hard::under_mode(hard::kOddestFpMode, [&] { return surface(c.mesh, ray, hit); });
          REQUIRE(s.u == other.u);
          REQUIRE(s.v == other.v);
          REQUIRE(s.point == other.point);
          REQUIRE(s.normal == other.normal);
          ++hits_seen;
        }
      }
    }
    CHECK(hits_seen > 1000);
  }

  TEST_CASE("what cannot be answered is an error that names the triangle") {
    const TriangleMesh mesh = one_triangle({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
    const Ray ray = ray_of({0.25f, 0.25f, 0}, {0, 0, 1});
    const auto names = [](const std::string& message, const char* what) {
      return message.find(what) != std::string::npos;
    };
    CHECK(message_of(mesh, ray, {1.0f, 0}).empty());
    CHECK(names(message_of(mesh, ray, Hit{}), "miss"));
    CHECK(names(message_of(mesh, ray, {1.0f, 1}), "triangle 1 is not in the mesh"));
    CHECK(names(message_of(mesh, ray, {1.0f, 6}, 7), "triangle 6 is not in the mesh"));
    CHECK(names(message_of(mesh, ray, {1.0f, 8}, 7), "triangle 8 is not in the mesh"));
    CHECK(message_of(mesh, ray, {1.0f, 7}, 7).empty());

    // Beside the triangle, in its plane, and rays that see nothing.
    CHECK(names(message_of(mesh, ray_of({2, 2, 0}, {0, 0, 1}), {1.0f, 0}), "triangle 0 is not met"));
    CHECK(names(message_of(mesh, ray_of({-1, 0.25f, 1}, {1, 0, 0}), {1.0f, 0}), "triangle 0 is not met"));
    CHECK(names(message_of(mesh, ray_of({0, 0, 0}, {0, 0, 0}), {1.0f, 0}), "triangle 0 is not met"));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    CHECK(names(message_of(mesh, ray_of({nan, 0, 0}, {0, 0, 1}), {1.0f, 0}), "triangle 0 is not met"));

    // Triangles that are never hit.
    const TriangleMesh segment = one_triangle({{0, 0, 1}, {1, 1, 1}, {0.5f, 0.5f, 1}});
    CHECK(names(message_of(segment, ray, {1.0f, 0}), "triangle 0 is not met"));
    const TriangleMesh infinite = one_triangle({{0, 0, 1}, {1, 0, INFINITY}, {0, 1, 1}});
    CHECK(names(message_of(infinite, ray, {1.0f, 0}), "triangle 0 is not met"));
    const TriangleMesh broken{mesh.positions, {{0, 1, 2}, {0, 3, 1}}};
    CHECK(message_of(broken, ray, {1.0f, 0}).empty());
    CHECK(names(message_of(broken, ray, {1.0f, 1}), "vertex index 3"));
  }

  TEST_CASE("every answer of a tree has a surface") {
    for (const hard::Case& c : hard::make_cases(3, 48)) {
      const Bvh bvh(c.mesh);
      for (const Ray& ray : c.rays) {
        const Hit hit = bvh.closest(ray);
        if (hit.id != kNone) CHECK_NOTHROW(surface(c.mesh, ray, hit));
      }
    }
  }
}
