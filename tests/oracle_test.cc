#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "oracle/exact.h"
#include "oracle/oracle.h"

// The oracle's own cases, each worked out by hand from docs/visibility.md.

using namespace oracle;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kMax = std::numeric_limits<float>::max();

float up(float f) { return std::nextafter(f, kInf); }
float down(float f) { return std::nextafter(f, -kInf); }

Ray ray_of(Vec3 origin, Vec3 direction, float tmin = 0.0f, float tmax = kInf) {
  return {origin, tmin, direction, tmax};
}

// A right-angled triangle about the z axis in the plane z.
Triangle target(float z, std::uint32_t id = 0) { return {{-1, -1, z}, {3, -1, z}, {-1, 3, z}, id}; }

Triangle reversed(const Triangle& t) { return {t.v0, t.v2, t.v1, t.id}; }

std::size_t hit_count(const std::vector<Triangle>& triangles, const Ray& ray) {
  return Scene(triangles).all(ray).size();
}

// Triangles of a closed surface from its corners and faces.
std::vector<Triangle> surface(const std::vector<Vec3>& corners,
                              const std::vector<std::array<int, 3>>& faces) {
  std::vector<Triangle> triangles;
  for (const auto& f : faces) {
    const auto corner = [&](int i) {
      return corners[static_cast<std::size_t>(f[static_cast<std::size_t>(i)])];
    };
    triangles.push_back({corner(0), corner(1), corner(2), static_cast<std::uint32_t>(triangles.size())});
  }
  return triangles;
}

std::vector<Triangle> octahedron() {
  return surface({{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 2}, {0, 0, -2}},
                 {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
}

std::vector<Triangle> cube() {
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back({i & 1 ? 2.0f : -2.0f, i & 2 ? 2.0f : -2.0f, i & 4 ? 2.0f : -2.0f});
  }
  return surface(corners, {{0, 1, 3},
                           {0, 3, 2},
                           {4, 5, 7},
                           {4, 7, 6},
                           {0, 1, 5},
                           {0, 5, 4},
                           {2, 3, 7},
                           {2, 7, 6},
                           {0, 2, 6},
                           {0, 6, 4},
                           {1, 3, 7},
                           {1, 7, 5}});
}

}  // namespace

TEST_SUITE("oracle: rounding") {
  TEST_CASE("scaled floats are integers of 2^-149") {
    CHECK(scaled(0.0f) == 0);
    CHECK(scaled(-0.0f) == 0);
    CHECK(scaled(0x1p-149f) == 1);
    CHECK(scaled(-0x1p-149f) == -1);
    CHECK(scaled(0x1p-126f) == mpz_class(1) << 23);
    CHECK(scaled(0x1.8p-126f) == mpz_class(3) << 22);
    CHECK(scaled(1.0f) == mpz_class(1) << 149);
    CHECK(scaled(kMax) == (mpz_class(1) << 277) - (mpz_class(1) << 253));
  }

  TEST_CASE("ratios round to the nearest float, ties to even") {
    const mpz_class one = mpz_class(1) << 24;
    CHECK(nearest_float(one, one) == 1.0f);
    CHECK(nearest_float(one + 1, one) == 1.0f);                     // a tie, down to the even one
    CHECK(nearest_float(one + 3, one) == 1.0f + 0x1p-22f);          // a tie, up to the even one
    CHECK(nearest_float(2 * one + 3, 2 * one) == 1.0f + 0x1p-23f);  // above the tie
    CHECK(nearest_float(2 * one - 1, 2 * one) == 1.0f);             // a tie across a power of two
    CHECK(nearest_float(4 * one - 3, 4 * one) == 1.0f - 0x1p-24f);  // below that tie
    CHECK(nearest_float(-(one + 3), one) == -(1.0f + 0x1p-22f));
    CHECK(nearest_float(one + 3, -one) == -(1.0f + 0x1p-22f));
    CHECK(nearest_float(1, 3) == 0x1.555556p-2f);
    CHECK(nearest_float(2, 3) == 0x1.555556p-1f);
    CHECK(nearest_float(0, -7) == 0.0f);
  }

  TEST_CASE("subnormal and overflowing ratios round like all others") {
    const mpz_class one = mpz_class(1) << 150;  // one / 2^299 is 2^-149
    const mpz_class d = mpz_class(1) << 299;
    CHECK(nearest_float(one, d) == 0x1p-149f);
    CHECK(nearest_float(one / 2, d) == 0.0f);
    CHECK(nearest_float(one / 2 + 1, d) == 0x1p-149f);
    CHECK(nearest_float(3 * one / 2, d) == 0x1p-148f);
    CHECK(nearest_float(one << 22, d) == 0x1p-127f);
    CHECK(nearest_float((one << 23) - one / 2, d) == 0x1p-126f);  // a tie from subnormal to normal
    const mpz_class limit = (mpz_class(1) << 128) - (mpz_class(1) << 103);
    CHECK(nearest_float(limit, 1) == kInf);
    CHECK(nearest_float(-limit, 1) == -kInf);
    CHECK(nearest_float(limit - 1, 1) == kMax);
    CHECK(nearest_float(2 * limit - 1, 2) == kMax);
    CHECK(nearest_float(mpz_class(1) << 4000, 1) == kInf);
    CHECK(nearest_float(1, mpz_class(1) << 4000) == 0.0f);
  }

  TEST_CASE("doubles round to the nearest float, ties to even") {
    CHECK(nearest_float(0x1.000001p0) == 1.0f);
    CHECK(nearest_float(0x1.000003p0) == 0x1.000004p0f);
    CHECK(nearest_float(-0x1.0000010000001p0) == -0x1.000002p0f);
    CHECK(nearest_float(0x1p-150) == 0.0f);
    CHECK(nearest_float(0x1.0000000000001p-150) == 0x1p-149f);
    CHECK(nearest_float(0x1.fffffefffffffp127) == kMax);
    CHECK(nearest_float(0x1.ffffffp127) == kInf);
    CHECK(nearest_float(-1e300) == -kInf);
    CHECK(nearest_float(-double{kInf}) == -kInf);
    CHECK(std::isnan(nearest_float(double{kNan})));
    CHECK(nearest_float(0.0) == 0.0f);
    CHECK(nearest_float(5e-324) == 0.0f);
  }
}

TEST_SUITE("oracle: coverage") {
  TEST_CASE("an edge inside a surface is hit exactly once") {
    const std::vector<Triangle> square = {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, 0},
                                          {{-1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, 1}};
    for (const float s : {-0.75f, -0.5f, 0.0f, 0.25f, 0.875f}) {
      CHECK(hit_count(square, ray_of({s, s, 0}, {0, 0, 1})) == 1);
      CHECK(hit_count(square, ray_of({0, 0, 0}, {s, s, 1})) == 1);
      CHECK(hit_count(square, ray_of({0, 0, 3}, {s, s, -2})) == 1);
    }
  }

  TEST_CASE("the displacement decides which side of the diagonal a ray goes") {
    const std::vector<Triangle> square = {{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, 0},
                                          {{-1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, 1}};
    // (0, 0, 1) + (e, e^2, e^3) leans to +x first: below the diagonal y = x.
    CHECK(Scene(square).closest(ray_of({0, 0, 0}, {0, 0, 1})) == Hit{1.0f, 0});
    // Backward along the line the displaced ray still leans to +x in the plane z = 1 seen from z = 2.
    CHECK(Scene(square).closest(ray_of({0, 0, 2}, {0, 0, -1})) == Hit{1.0f, 0});
  }

  TEST_CASE("the inner vertex of a fan is hit exactly once") {
    for (const int spokes : {3, 4, 5, 8}) {
      std::vector<Vec3> rim;
      constexpr std::array<Vec3, 8> kRim = {
          {{2, 0, 5}, {1, 1, 5}, {0, 2, 5}, {-1, 1, 5}, {-2, 0, 5}, {-1, -1, 5}, {0, -2, 5}, {1, -1, 5}}};
      for (int i = 0; i < spokes; ++i) rim.push_back(kRim[static_cast<std::size_t>(i * 8 / spokes)]);
      std::vector<Triangle> fan;
      for (std::size_t i = 0; i < rim.size(); ++i) {
        fan.push_back({{0, 0, 5}, rim[i], rim[(i + 1) % rim.size()], static_cast<std::uint32_t>(i)});
      }
      CHECK(hit_count(fan, ray_of({0, 0, 0}, {0, 0, 1})) == 1);
      CHECK(hit_count(fan, ray_of({3, -7, 1}, {-3, 7, 4})) == 1);
      CHECK(hit_count(fan, ray_of({0, 0, 9}, {0.0f, -0.0f, -1})) == 1);
      CHECK(hit_count(fan, ray_of({5, 5, 0}, {-1, -1, 1})) == 1);
    }
  }

  TEST_CASE("the rim of an open surface is hit or missed as the displaced ray would") {
    const std::vector<Triangle> one = {target(1)};
    // The left edge x = -1: leaning to +x goes inside. The bottom edge y = -1: leaning to +x stays on
    // the line as far as e goes, then e^2 lifts it inside. The slanted edge x + y = 2: out.
    CHECK(hit_count(one, ray_of({-1, 0, 0}, {0, 0, 1})) == 1);
    CHECK(hit_count(one, ray_of({0, -1, 0}, {0, 0, 1})) == 1);
    CHECK(hit_count(one, ray_of({1, 1, 0}, {0, 0, 1})) == 0);
    CHECK(hit_count(one, ray_of({-1, -1, 0}, {0, 0, 1})) == 1);
    CHECK(hit_count(one, ray_of({3, -1, 0}, {0, 0, 1})) == 0);
    CHECK(hit_count(one, ray_of({-1, 3, 0}, {0, 0, 1})) == 0);
  }

  TEST_CASE("a silhouette edge is hit twice at one depth or not at all") {
    // Two faces that meet in the segment x = 0, z = 2, and lie on its right or left, seen along z.
    const auto wedge = [](float x) {
      return std::vector<Triangle>{{{0, -1, 2}, {0, 1, 2}, {x, 0, 1}, 0},
                                   {{0, -1, 2}, {0, 1, 2}, {x, 0, 3}, 1}};
    };
    const Ray along_z = ray_of({0, 0, 0}, {0, 0, 1});
    const std::vector<Hit> right = Scene(wedge(1)).all(along_z);
    REQUIRE(right.size() == 2);
    CHECK(right[0] == Hit{2.0f, 0});
    CHECK(right[1] == Hit{2.0f, 1});
    CHECK(Scene(wedge(-1)).all(along_z).empty());
  }

  TEST_CASE("a ray in the triangle's plane misses it") {
    const std::vector<Triangle> one = {target(0)};
    CHECK(hit_count(one, ray_of({-5, 0, 0}, {1, 0, 0})) == 0);
    CHECK(hit_count(one, ray_of({-5, -1, 0}, {1, 0, 0})) == 0);
    CHECK(hit_count(one, ray_of({-1, -5, 0}, {0, 1, 0})) == 0);
    CHECK(hit_count(one, ray_of({0, 0, 0}, {1, 1, 0})) == 0);
    const Triangle slanted = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, 0};
    CHECK(hit_count({slanted}, ray_of({2, 0, -1}, {-1, 0, 1})) == 0);
    CHECK_FALSE(plane_depth({2, 0, -1}, {-1, 0, 1}, slanted).has_value());
  }

  TEST_CASE("an origin on an edge's line misses the edge's triangles") {
    const std::vector<Triangle> one = {target(0)};
    CHECK(hit_count(one, ray_of({0, -1, 0}, {0, 1, 5})) == 0);   // on the edge
    CHECK(hit_count(one, ray_of({9, -1, 0}, {-8, 1, 1})) == 0);  // on its line
    CHECK(hit_count(one, ray_of({-1, -1, 0}, {1, 1, 5})) == 0);  // on a vertex
  }

  TEST_CASE("an origin on the surface does not see it") {
    CHECK(hit_count({target(0)}, ray_of({0, 0, 0}, {0, 0, 1})) == 0);
    CHECK(line_hit({0, 0, 0}, {0, 0, 1}, target(0)) == 0.0f);
  }

  TEST_CASE("zero-area triangles are never hit") {
    const std::vector<Triangle> flat = {{{-1, 0, 1}, {1, 0, 1}, {0, 0, 1}, 0},
                                        {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, 1},
                                        {{-1, 0, 1}, {1, 0, 1}, {1, 0, 1}, 2}};
    CHECK(hit_count(flat, ray_of({0, 0, 0}, {0, 0, 1})) == 0);
    CHECK(hit_count(flat, ray_of({0.5f, 3, 1}, {0, -1, 0})) == 0);
    CHECK(hit_count(flat, ray_of({-5, 0, 1}, {1, 0, 0})) == 0);
  }

  TEST_CASE("reversing or rotating a triangle's corners changes nothing") {
    const Triangle t = target(3);
    for (int y = -4; y <= 8; ++y) {
      for (int x = -4; x <= 8; ++x) {
        const Vec3 direction = {0.5f * static_cast<float>(x), 0.5f * static_cast<float>(y), 3};
        const std::optional<float> hit = line_hit({0, 0, 0}, direction, t);
        CHECK(line_hit({0, 0, 0}, direction, reversed(t)) == hit);
        CHECK(line_hit({0, 0, 0}, direction, {t.v1, t.v2, t.v0, 0}) == hit);
        CHECK(line_hit({0, 0, 0}, direction, {t.v2, t.v1, t.v0, 0}) == hit);
      }
    }
  }

  TEST_CASE("a closed surface is crossed an even number of times from outside") {
    for (const std::vector<Triangle>& closed : {octahedron(), cube()}) {
      const Scene scene(closed);
      std::size_t crossings = 0;
      for (const Vec3 origin :
           {Vec3{-5, -5, -5}, Vec3{5, 0, 0}, Vec3{0, 3, 7}, Vec3{-4, 4, 0}, Vec3{2, 2, -6}}) {
        // At every half of a lattice point in and around it: vertices, edges, planes and the inside.
        for (int i = 0; i < 13 * 13 * 13; ++i) {
          const auto coordinate = [i](int stride) { return 0.5f * static_cast<float>(i / stride % 13 - 6); };
          const Vec3 aim = {coordinate(1) - origin.x, coordinate(13) - origin.y, coordinate(169) - origin.z};
          if (aim.x == 0.0f && aim.y == 0.0f && aim.z == 0.0f) continue;
          const std::size_t count = scene.all(ray_of(origin, aim)).size();
          CHECK(count % 2 == 0);
          crossings += count;
        }
      }
      CHECK(crossings > 4000);
    }
  }

  TEST_CASE("from inside a convex surface every ray leaves exactly once") {
    for (const std::vector<Triangle>& closed : {octahedron(), cube()}) {
      const Scene scene(closed);
      for (int i = 0; i < 5 * 5 * 5; ++i) {
        const auto coordinate = [i](int stride) { return static_cast<float>(i / stride % 5 - 2); };
        const Vec3 direction = {coordinate(1), coordinate(5), coordinate(25)};
        if (direction.x == 0.0f && direction.y == 0.0f && direction.z == 0.0f) continue;
        CHECK(scene.all(ray_of({0, 0, 0}, direction)).size() == 1);
      }
    }
  }
}

TEST_SUITE("oracle: depth") {
  TEST_CASE("depth is rounded first, then the id decides") {
    const float z = 3.0f + 0x1p-22f;
    const Scene scene({target(3, 1), target(z, 0)});
    const std::vector<Hit> hits = scene.all(ray_of({0, 0, 0}, {0, 0, 5}));
    CHECK(hits == std::vector<Hit>{{0.6f, 0}, {0.6f, 1}});
    // Along (0, 0, 1) the depths are the two floats themselves.
    CHECK(scene.closest(ray_of({0, 0, 0}, {0, 0, 1})) == Hit{3.0f, 1});
  }

  TEST_CASE("depth rounds ties to even") {
    const Vec3 origin = {0, 0, -0x1p-24f};  // t = z + 2^-24 along (0, 0, 1)
    const Vec3 along = {0, 0, 1};
    CHECK(line_hit(origin, along, target(1)) == 1.0f);
    CHECK(line_hit(origin, along, target(1 + 0x1p-23f)) == 1 + 0x1p-22f);
    CHECK(line_hit(origin, {0, 0, -1}, target(1)) == -1.0f);
    CHECK(line_hit({0, 0, -0x1.000002p-24f}, along, target(1)) == 1 + 0x1p-23f);  // just above the tie
  }

  TEST_CASE("a subnormal depth is returned as it is") {
    CHECK(line_hit({0, 0, 0}, {0, 0, 0x1p100f}, target(0x1p-49f)) == 0x1p-149f);
    CHECK(line_hit({0, 0, 0}, {0, 0, 0x1p100f}, target(0x1.8p-49f)) == 0x1p-148f);  // a tie to even
    CHECK(line_hit({0, 0, 0}, {0, 0, 0x1p100f}, target(0x1p-40f)) == 0x1p-140f);
    CHECK(hit_count({target(0x1p-49f)}, ray_of({0, 0, 0}, {0, 0, 0x1p100f})) == 1);
    // Half of the least subnormal rounds to zero, which is not seen; anything more does.
    CHECK(line_hit({0, 0, 0}, {0, 0, 0x1p100f}, target(0x1p-50f)) == 0.0f);
    CHECK(hit_count({target(0x1p-50f)}, ray_of({0, 0, 0}, {0, 0, 0x1p100f})) == 0);
    CHECK(hit_count({target(0x1.000002p-50f)}, ray_of({0, 0, 0}, {0, 0, 0x1p100f})) == 1);
  }

  TEST_CASE("a depth that rounds to infinity is a miss") {
    // The greatest float is 2^128 - 2^104.
    const Vec3 along = {0, 0, 1};
    CHECK(line_hit({0, 0, 0}, along, target(kMax)) == kMax);
    CHECK(line_hit({0, 0, -0x1p102f}, along, target(kMax)) == kMax);            // 2^128 - 2^104 + 2^102
    CHECK_FALSE(line_hit({0, 0, -0x1p103f}, along, target(kMax)).has_value());  // 2^128 - 2^103, the limit
    CHECK(line_hit({0, 0, -down(0x1p103f)}, along, target(kMax)) == kMax);      // just below it
    CHECK(plane_depth({0, 0, -0x1p103f}, along, target(kMax)) == kInf);
    CHECK_FALSE(line_hit({0, 0, 0}, {0, 0, 0x1p-149f}, target(1)).has_value());  // 2^149
    CHECK_FALSE(line_hit({0, 0, 0}, {0, 0, -0x1p-149f}, target(1)).has_value());
    CHECK(hit_count({target(kMax)}, ray_of({0, 0, -0x1p103f}, along)) == 0);
  }

  TEST_CASE("extreme inputs have their full value") {
    const Triangle tiny = {{-0x1p-149f, -0x1p-149f, 0x1p-149f},
                           {0x1p-147f, -0x1p-149f, 0x1p-149f},
                           {-0x1p-149f, 0x1p-147f, 0x1p-149f},
                           0};
    CHECK(line_hit({0, 0, 0}, {0, 0, 0x1p-149f}, tiny) == 1.0f);
    CHECK(line_hit({0, 0, 0}, {0x1p-149f, 0, 0x1p-149f}, tiny) == 1.0f);
    const Triangle huge = {{-kMax, -kMax, kMax}, {kMax, -kMax, kMax}, {-kMax, kMax, kMax}, 0};
    CHECK(line_hit({-1, -1, 0}, {0, 0, kMax}, huge) == 1.0f);
    CHECK(line_hit({-1, -1, -kMax}, {0, 0, kMax}, huge) == 2.0f);
    CHECK_FALSE(line_hit({1, 1, 0}, {0, 0, kMax}, huge).has_value());
  }
}

TEST_SUITE("oracle: what counts") {
  TEST_CASE("tmin is open and tmax closed, both on the rounded depth") {
    const std::vector<Triangle> one = {target(2)};
    const auto seen = [&](float tmin, float tmax) {
      return Scene(one).any(ray_of({0, 0, 0}, {0, 0, 1}, tmin, tmax));
    };
    CHECK(seen(0, kInf));
    CHECK(seen(down(2), 2));
    CHECK_FALSE(seen(2, kInf));
    CHECK_FALSE(seen(up(2), kInf));
    CHECK_FALSE(seen(0, down(2)));
    CHECK(seen(-kInf, 2));
    CHECK(seen(-3, kMax));
    CHECK_FALSE(seen(kInf, kInf));
    CHECK_FALSE(seen(0, -kInf));
    CHECK_FALSE(seen(0, 0));
    // 3 and 3 + 2^-22 over 5 both round to 0.6: a tmax of 0.6 keeps the farther one as well.
    const Scene pair({target(3, 1), target(3 + 0x1p-22f, 0)});
    CHECK(pair.all(ray_of({0, 0, 0}, {0, 0, 5}, 0, 0.6f)).size() == 2);
    CHECK(pair.all(ray_of({0, 0, 0}, {0, 0, 5}, 0.6f, kInf)).empty());
  }

  TEST_CASE("nothing behind the origin is seen, whatever tmin") {
    CHECK(hit_count({target(-1)}, ray_of({0, 0, 0}, {0, 0, 1}, -10)) == 0);
    CHECK(line_hit({0, 0, 0}, {0, 0, 1}, target(-1)) == -1.0f);
  }

  TEST_CASE("rays that are none see nothing") {
    const std::vector<Triangle> one = {target(2)};
    for (const float bad : {kNan, kInf, -kInf}) {
      for (int i = 0; i < 3; ++i) {
        std::array<float, 3> v = {0, 0, 0};
        v[static_cast<std::size_t>(i)] = bad;
        CHECK(hit_count(one, ray_of({v[0], v[1], v[2]}, {0, 0, 1})) == 0);
        CHECK(hit_count(one, ray_of({0, 0, 0}, {v[0], v[1], v[2] + 1.0f})) == 0);
      }
    }
    CHECK(hit_count(one, ray_of({0, 0, 0}, {0, 0, 1}, kNan)) == 0);
    CHECK(hit_count(one, ray_of({0, 0, 0}, {0, 0, 1}, 0, kNan)) == 0);
    CHECK(hit_count(one, ray_of({0, 0, 0}, {0.0f, -0.0f, 0.0f})) == 0);
    CHECK(Scene(one).closest(ray_of({0, 0, 0}, {0, 0, 0})) == Hit{kInf, kNone});
    CHECK(hit_count(one, ray_of({0, 0, 0}, {0, 0, 0x1p-126f})) == 1);
    CHECK(hit_count(one, ray_of({0, 0, 1.9999999f}, {0, 0, 0x1p-149f})) == 1);
  }

  TEST_CASE("triangles with a NaN or infinite coordinate are never seen") {
    for (const float bad : {kNan, kInf, -kInf}) {
      Triangle a = target(2, 0), b = target(2, 1), c = target(2, 2);
      a.v0.x = bad;
      b.v1.y = bad;
      c.v2.z = bad;
      CHECK(hit_count({a, b, c}, ray_of({0, 0, 0}, {0, 0, 1})) == 0);
      CHECK(Scene({a, b, c, target(2, 3)}).closest(ray_of({0, 0, 0}, {0, 0, 1})) == Hit{2.0f, 3});
    }
  }

  TEST_CASE("equal triangles are different hits, sorted by id") {
    const std::vector<Hit> hits = Scene({target(2, 7), reversed(target(2, 3)), target(1, 9), target(2, 5)})
                                      .all(ray_of({0, 0, 0}, {0, 0, 1}));
    CHECK(hits == std::vector<Hit>{{1.0f, 9}, {2.0f, 3}, {2.0f, 5}, {2.0f, 7}});
  }

  TEST_CASE("an empty scene is empty") {
    const Scene empty({});
    CHECK(empty.closest(ray_of({0, 0, 0}, {0, 0, 1})) == Hit{});
    CHECK_FALSE(empty.any(ray_of({0, 0, 0}, {0, 0, 1})));
  }
}

TEST_SUITE("oracle: camera") {
  TEST_CASE("a simple view has the values worked out by hand") {
    // tan(45 degrees) in double rounds to the float 1.
    const std::optional<Camera> camera = look_at({0, 0, 0}, {0, 0, -2}, {0, 3, 0}, 90, 4, 2);
    REQUIRE(camera.has_value());
    CHECK(camera->corner.x == -2);
    CHECK(camera->corner.y == 1);
    CHECK(camera->corner.z == -1);
    CHECK(camera->du.x == 1);
    CHECK(camera->dv.y == -1);
    const Ray ray = camera->ray(3, 0);
    CHECK(ray.direction.x == 1.5f);
    CHECK(ray.direction.y == 0.5f);
    CHECK(ray.direction.z == -1.0f);
    CHECK(ray.tmin == 0.0f);
    CHECK(ray.tmax == kInf);
    CHECK(camera->ray(-1, 5).direction.x == -2.5f);
  }

  TEST_CASE("a direction is rounded once, from the double") {
    const Camera camera{{0, 0, 0}, {0x1.000001p0, 0x1.000003p0, 1e39}, {0, 0, 0}, {0, 0, 0}, 1, 1};
    const Ray ray = camera.ray(0, 0);
    CHECK(ray.direction.x == 1.0f);
    CHECK(ray.direction.y == 0x1.000004p0f);
    CHECK(ray.direction.z == kInf);
    CHECK_FALSE(can_see(ray));
  }

  TEST_CASE("inputs that the definition calls errors are") {
    const Vec3 o = {0, 0, 0}, z = {0, 0, 1}, y = {0, 1, 0};
    CHECK(look_at(o, z, y, 60, 1, 1).has_value());
    CHECK_FALSE(look_at(o, o, y, 60, 1, 1).has_value());
    CHECK_FALSE(look_at(o, z, z, 60, 1, 1).has_value());
    CHECK_FALSE(look_at(o, z, {0, 0, 0}, 60, 1, 1).has_value());
    CHECK_FALSE(look_at({kNan, 0, 0}, z, y, 60, 1, 1).has_value());
    CHECK_FALSE(look_at(o, {0, kInf, 0}, y, 60, 1, 1).has_value());
    CHECK_FALSE(look_at(o, z, {0, -kInf, 0}, 60, 1, 1).has_value());
    for (const double fov : {0.0, -1.0, 180.0, double{kInf}, double{kNan}, 1e-50}) {
      CHECK_FALSE(look_at(o, z, y, fov, 1, 1).has_value());
    }
    CHECK_FALSE(look_at(o, z, y, 60, 0, 1).has_value());
    CHECK_FALSE(look_at(o, z, y, 60, 1, -1).has_value());
  }

  TEST_CASE("a frame holds the closest hit of every pixel's ray, rows from the top") {
    const Scene scene({target(-2, 4)});  // x and y from -1 on
    const std::optional<Camera> camera = look_at({0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90, 4, 4);
    REQUIRE(camera.has_value());
    const Frame frame = render(scene, *camera);
    // Pixel centres at z = -2 are x, -y = -1.5, -0.5, 0.5, 1.5. Inside are x, y > -1 with x + y < 2; two
    // lie on the edge x + y = 2 and lean outside.
    const std::vector<int> expected = {0, 1, 0, 0,  //
                                       0, 1, 1, 0,  //
                                       0, 1, 1, 1,  //
                                       0, 0, 0, 0};
    REQUIRE(frame.pixels.size() == 16);
    for (std::size_t i = 0; i < 16; ++i) {
      CHECK(frame.pixels[i] == (expected[i] != 0 ? Hit{2.0f, 4} : Hit{}));
    }
  }
}

TEST_SUITE("oracle: prefilter") {
  TEST_CASE("the prefilter changes no answer") {
    // Lattice triangles of mixed scales and lattice rays: most touch vertices, edges and planes.
    std::uint64_t state = 1;
    const auto next = [&state](float scale) {
      state = state * 6364136223846793005u + 1442695040888963407u;
      return scale * static_cast<float>(static_cast<int>(state >> 61) - 3);
    };
    std::size_t hits = 0;
    std::size_t left_out = 0;
    for (const float scale : {1.0f, 0x1p-147f, 0x1p-20f, 0x1p124f}) {
      for (int round = 0; round < 20; ++round) {
        std::vector<Triangle> triangles;
        for (std::uint32_t id = 0; id < 100; ++id) {
          const float s = round % 2 == 0 ? scale : scale * (id % 3 == 0 ? 0.5f : 1.0f);
          triangles.push_back(
              {{next(s), next(s), next(s)}, {next(s), next(s), next(s)}, {next(s), next(s), next(s)}, id});
        }
        const Scene filtered(triangles);
        const Scene plain(triangles, Scene::Filter::kPlain);
        const Prefilter prefilter(triangles);
        for (int i = 0; i < 20; ++i) {
          const Ray ray = ray_of({next(scale), next(scale), next(scale)}, {next(1), next(1), next(scale)});
          const std::vector<Hit> expected = plain.all(ray);
          CHECK(filtered.all(ray) == expected);
          hits += expected.size();
          if (can_see(ray)) left_out += triangles.size() - prefilter.candidates(ray).size();
        }
      }
    }
    CHECK(hits > 1000);
    CHECK(left_out > 20000);
  }
}
