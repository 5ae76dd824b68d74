// Clipped boxes against exact points of the triangles.

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include <gmpxx.h>

#include "build/clip_triangle.h"
#include "exact/intersect.h"
#include "support/effort.h"
#include "support/random.h"

using namespace plumb;
using plumb::detail::Box;
using plumb::detail::Triangle;
using plumb::hard::Random;

namespace {

using Point = std::array<mpq_class, 3>;

Point point_of(const glm::vec3& v) { return {mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)}; }

Point mix(const Point& a, const Point& b, const mpq_class& f) {
  Point r;
  for (std::size_t k = 0; k < 3; ++k) r[k] = a[k] + f * (b[k] - a[k]);
  return r;
}

bool within(const Point& p, const Box& box) {
  for (int k = 0; k < 3; ++k) {
    const mpq_class& x = p[static_cast<std::size_t>(k)];
    if (x < mpq_class(box.lo[k]) || x > mpq_class(box.hi[k])) return false;
  }
  return true;
}

// The exact clipped triangle's corners.
std::vector<Point> exact_clip(const Triangle& triangle, const Box& cell) {
  std::vector<Point> polygon{point_of(triangle.v0), point_of(triangle.v1), point_of(triangle.v2)};
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    for (const int sign : {-1, 1}) {
      const mpq_class plane(sign < 0 ? cell.lo[axis] : cell.hi[axis]);
      std::vector<Point> kept;
      for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point& a = polygon[i];
        const Point& b = polygon[(i + 1) % polygon.size()];
        const mpq_class outside_a = sign * (a[k] - plane), outside_b = sign * (b[k] - plane);
        if (outside_a <= 0) kept.push_back(a);
        if ((outside_a < 0 && outside_b > 0) || (outside_a > 0 && outside_b < 0))
          kept.push_back(mix(a, b, (plane - a[k]) / (b[k] - a[k])));
      }
      polygon = kept;
    }
  }
  return polygon;
}

float nearby(Random& random, float x, float size) {
  switch (random.below(4)) {
    case 0:
      return x;
    case 1:
      return std::nextafter(x, random.one_in(2) ? 1e30f : -1e30f);
    case 2:
      return x + size * random.unit();
    default:
      return x + size * random.unit() * std::ldexp(1.0f, -random.between(0, 30));
  }
}

Triangle random_triangle(Random& random) {
  const float scale = std::ldexp(1.0f, random.one_in(2) ? 0 : random.between(-130, 120));
  const float size = scale * std::ldexp(1.0f, -random.between(0, 20));
  glm::vec3 v[3];
  v[0] = random.unit3() * scale;
  for (int i = 1; i < 3; ++i) {
    for (int axis = 0; axis < 3; ++axis)
      v[i][axis] = nearby(random, v[random.below(static_cast<std::uint32_t>(i))][axis], size);
  }
  return {v[0], v[1], v[2]};
}

// A cell with faces at the triangle's corners, near them or anywhere about.
Box random_cell(Random& random, const Triangle& triangle) {
  const Box own = detail::box_of(triangle);
  Box cell;
  for (int axis = 0; axis < 3; ++axis) {
    const float places[] = {triangle.v0[axis], triangle.v1[axis], triangle.v2[axis]};
    const float size = own.hi[axis] * 0.5f - own.lo[axis] * 0.5f;
    const float a = nearby(random, places[random.below(3)], size);
    const float b = random.one_in(8) ? a : nearby(random, places[random.below(3)], size);
    cell.lo[axis] = std::min(a, b) + 0.0f;
    cell.hi[axis] = std::max(a, b) + 0.0f;
  }
  return cell;
}

}  // namespace

TEST_SUITE("k-d tree: clip") {
  TEST_CASE("every point of a triangle in a cell is in the clipped box, which is little larger") {
    Random random(1);
    int met = 0, cut = 0, found_empty = 0, lost = 0, loose = 0;
    for (int i = 0; i < hard::effort(100'000); ++i) {
      const Triangle triangle = random_triangle(random);
      const Box cell = random_cell(random, triangle);
      const std::vector<Point> exact = exact_clip(triangle, cell);
      Box box;
      const bool some = detail::clip_triangle(triangle, cell, box);
      met += exact.empty() ? 0 : 1;
      cut += exact.size() > 3 ? 1 : 0;
      if (!some) {
        ++found_empty;
        lost += exact.empty() ? 0 : 1;
        continue;
      }
      const Box own = detail::box_of(triangle);
      for (const Point& p : exact) lost += within(p, box) ? 0 : 1;
      for (int axis = 0; axis < 3; ++axis) {
        CHECK(box.lo[axis] >= cell.lo[axis]);
        CHECK(box.hi[axis] <= cell.hi[axis]);
        CHECK(box.lo[axis] >= own.lo[axis]);
        CHECK(box.hi[axis] <= own.hi[axis]);
        if (exact.empty()) continue;
        // Loose: larger than a float further out than the exact one.
        const auto k = static_cast<std::size_t>(axis);
        const auto [lo, hi] = std::minmax_element(
            exact.begin(), exact.end(), [&](const Point& a, const Point& b) { return a[k] < b[k]; });
        const double slack =
            0x1p-22 * double{std::max(std::fabs(own.lo[axis]), std::fabs(own.hi[axis]))} + 0x1p-148;
        loose += mpq_class(box.lo[axis]) < (*lo)[k] - mpq_class(slack) ? 1 : 0;
        loose += mpq_class(box.hi[axis]) > (*hi)[k] + mpq_class(slack) ? 1 : 0;
      }
    }
    CHECK(lost == 0);
    CHECK(met > hard::effort(20'000));
    CHECK(cut > hard::effort(5'000));
    CHECK(found_empty > hard::effort(10'000));
    // A triangle that only just reaches into a cell may seem to reach further, where it is nearly in a plane.
    CHECK(loose < hard::effort(2'000));
    MESSAGE(met << " met, " << cut << " cut, " << found_empty << " found empty, " << loose << " loose");
  }

  TEST_CASE("a triangle in a face of the cell, one at its corner, one beside it") {
    const Box cell{{0, 0, 0}, {1, 1, 1}};
    Box box;
    REQUIRE(detail::clip_triangle({{-3, -3, 1}, {3, -3, 1}, {0, 9, 1}}, cell, box));
    CHECK(box.lo == glm::vec3(0, 0, 1));
    CHECK(box.hi == glm::vec3(1, 1, 1));
    REQUIRE(detail::clip_triangle({{1, 1, 1}, {2, 1, 1}, {1, 2, 2}}, cell, box));
    CHECK(box.lo == glm::vec3(1, 1, 1));
    CHECK(box.hi == glm::vec3(1, 1, 1));
    CHECK_FALSE(detail::clip_triangle({{1.0000001f, 1, 1}, {2, 1, 1}, {1.5f, 2, 2}}, cell, box));
    // Its box meets the cell, it does not.
    CHECK_FALSE(detail::clip_triangle({{1.5f, 0, 0}, {0, 1.6f, 0}, {1.5f, 1.6f, 0}},
                                      {{0, 0, 0}, {0.5f, 0.5f, 1}}, box));
  }
}
