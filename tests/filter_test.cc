// Attacks the float stage: whatever it calls certain must be so. Each Highway target by itself.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "filter_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "exact/filter-inl.h"
#include "hwy/highway.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// Bits of the possible and the certain lanes of a block of 8.
void Filter8(const FilterRay& ray, const TriangleBlock<8>& block, std::uint32_t& possible,
             std::uint32_t& certain) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<float, 8> d;
  possible = certain = 0;
  for (size_t lane = 0; lane < 8; lane += hn::Lanes(d)) {
    hn::Mask<decltype(d)> p;
    hn::Mask<decltype(d)> c;
    FilterTriangles(d, ray, block, lane, p, c);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, p, bits);
    possible |= static_cast<std::uint32_t>(bits[0]) << lane;
    hn::StoreMaskBits(d, c, bits);
    certain |= static_cast<std::uint32_t>(bits[0]) << lane;
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "base/simd_dispatch.h"
#include "exact/intersect.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Filter8);

using Random = std::mt19937_64;

float uniform(Random& random, float scale) {
  // The top 24 bits: the same on every machine, unlike <random>'s distributions.
  return (static_cast<float>(random() >> 40) * 0x1p-23f - 1.0f) * scale;
}

glm::vec3 point(Random& random, float scale) {
  return {uniform(random, scale), uniform(random, scale), uniform(random, scale)};
}

float power(Random& random, int least, int greatest) {
  return std::ldexp(1.0f, least + static_cast<int>(random() % static_cast<unsigned>(greatest - least + 1)));
}

glm::vec3 combine(const Triangle& t, float u, float v) {
  return t.v0 + (t.v1 - t.v0) * u + (t.v2 - t.v0) * v;
}

struct Case {
  Triangle triangle;
  Ray ray;
};

// A triangle near the origin or far, often a sliver or lattice-like, and a ray that mostly aims at a
// vertex, an edge or the interior of it.
Case draw(Random& random, int least_exponent, int greatest_exponent) {
  const float scale = power(random, least_exponent, greatest_exponent);
  const glm::vec3 centre = point(random, scale * power(random, -6, 12));
  Case c;
  c.triangle = {centre + point(random, scale), centre + point(random, scale), centre + point(random, scale)};
  if (random() % 4 == 0) c.triangle.v2 = c.triangle.v1 + point(random, scale * power(random, -22, -1));
  if (random() % 8 == 0) c.triangle.v2 = combine(c.triangle, uniform(random, 1.0f), 0.0f);
  c.ray.origin = centre + point(random, scale * power(random, -10, 10));
  const float u = 0.5f + uniform(random, 0.75f);
  const float v = 0.5f + uniform(random, 0.75f);
  glm::vec3 target = combine(c.triangle, u, v);
  switch (random() % 4) {
    case 0:
      target = c.triangle.v1;
      break;
    case 1:
      target = combine(c.triangle, u, 0.0f);
      break;
    case 2:
      target = combine(c.triangle, u, 1.0f - u);
      break;
    default:
      break;
  }
  c.ray.direction = (target - c.ray.origin) * power(random, -8, 8);
  if (random() % 3 == 0) c.ray.tmax = std::fabs(uniform(random, 2.0f));
  return c;
}

void attack(Random& random, Simd simd, int least_exponent, int greatest_exponent, std::size_t blocks,
            std::size_t& certain_count) {
  for (std::size_t n = 0; n < blocks; ++n) {
    TriangleBlock<8> block{};
    Case cases[8];
    for (Case& c : cases) c = draw(random, least_exponent, greatest_exponent);
    float greatest = 0.0f;
    for (std::size_t i = 0; i < 8; ++i) {
      const glm::vec3 corner[3] = {cases[i].triangle.v0, cases[i].triangle.v1, cases[i].triangle.v2};
      double extent = 0x1p-30;
      for (int v = 0; v < 3; ++v) {
        for (int axis = 0; axis < 3; ++axis) {
          block.vertex[v][axis][i] = corner[v][axis];
          greatest = std::max(greatest, std::fabs(corner[v][axis]));
        }
        const glm::vec3 edge = corner[v] - corner[0];
        extent = std::max(extent,
                          double{std::fabs(edge.x)} + double{std::fabs(edge.y)} + double{std::fabs(edge.z)});
      }
      block.extent[i] = std::nextafter(static_cast<float>(extent), std::numeric_limits<float>::infinity());
    }
    const Ray& ray = cases[random() % 8].ray;
    if (!ray_is_valid(ray) || !(ray.tmax > 0.0f)) continue;
    FilterRay filter(ray, greatest);
    filter.set_limit(depth_limit(ray.tmax));
    std::uint32_t possible = 0;
    std::uint32_t certain = 0;
    PLUMB_DISPATCH(Filter8, simd)(filter, block, possible, certain);
    for (std::size_t i = 0; i < 8; ++i) {
      float t = 0.0f;
      const Triangle& triangle = cases[i].triangle;
      const bool hit = line_hit(ray.origin, ray.direction, triangle, t);
      if ((possible >> i & 1u) == 0) {
        const bool counts = hit && depth_counts(ray, t);
        CHECK_FALSE(counts);
      } else if ((certain >> i & 1u) != 0) {
        // Covered, with a denominator that is not zero; only t may still round to infinity.
        const bool covered = hit || std::isinf(line_depth(ray.origin, ray.direction, triangle));
        CHECK(covered);
      }
      certain_count += ((possible & certain) >> i & 1u) != 0 || (possible >> i & 1u) == 0 ? 1 : 0;
    }
  }
}

}  // namespace

TEST_SUITE("float filter") {
  TEST_CASE("what it calls certain is so, on every target") {
    for (const Simd simd : simd_targets()) {
      CAPTURE(simd_name(simd));
      Random random(7);
      std::size_t certain = 0;
      attack(random, simd, -2, 2, 20000, certain);
      MESSAGE(simd_name(simd), ": ", certain, " of 160000 lanes certain at scale 1");
      CHECK(certain > 80000);
    }
  }

  TEST_CASE("it stays safe where floats underflow and overflow") {
    for (const Simd simd : simd_targets()) {
      CAPTURE(simd_name(simd));
      Random random(11);
      std::size_t certain = 0;
      attack(random, simd, -140, -40, 5000, certain);
      attack(random, simd, -40, -10, 5000, certain);
      attack(random, simd, 10, 50, 5000, certain);
      attack(random, simd, 50, 115, 5000, certain);
    }
  }
}

}  // namespace plumb::detail
#endif
