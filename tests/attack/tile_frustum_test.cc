// Attacks what a tile culls boxes by (tiles/tile_frustum.h): boxes as tight as floats allow about a point
// that a pixel of the tile sees, at distances great and small beside the eye's own coordinates, and the
// nearest depth that the tile may see already. Each Highway target by itself.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/tile_frustum_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "tiles/tile_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

std::uint32_t Meet(const WideNode<8>& node, const FrameFrustum& frame, const TileFrustum& tile, float low,
                   float near[8]) {
  HWY_ALIGN float of_child[8];
  const std::uint32_t met = MeetChildren<8>(node, frame, tile, low, of_child);
  std::copy_n(of_child, 8, near);
  return met;
}

// The least bound of 1/t of a pixel that sees something at t.
float LowOf(float t) {
  const hn::CappedTag<float, 4> d;
  auto low = hn::Zero(d), high = low;
  BoundsOf(d, hn::Set(d, t), low, high);
  return hn::GetLane(low);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <gmpxx.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "base/simd_dispatch.h"
#include "support/effort.h"
#include "support/random.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Meet);
HWY_EXPORT(LowOf);

using hard::Random;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// As look_at makes it, or any basis, its directions long or short; the eye's size is about 2^scale.
Camera draw_camera(Random& random, int scale) {
  const int width = random.between(1, 2000), height = random.between(1, 2000);
  const auto scaled = [&](int exponent) { return random.unit3() * std::ldexp(1.0f, exponent); };
  const glm::vec3 eye = random.one_in(8) ? glm::vec3(0.0f) : scaled(scale);
  glm::vec3 target = eye + scaled(scale - random.between(0, 8));
  if (target == eye) target.x += std::ldexp(1.0f, scale + 1);
  // Along an axis or a plane in some: then the sign of a component changes within the tile.
  for (int axis = 0; axis < 3; ++axis) {
    if (random.one_in(4)) target[axis] = eye[axis];
  }
  if (target == eye) target.z = eye.z == 0.0f ? 1.0f : 2.0f * eye.z;
  Camera camera =
      Camera::look_at(eye, target, {0.01f, 1.0f, 0.02f}, random.one_in(2) ? 60.0 : 0.2, width, height);
  if (random.one_in(4)) {
    const double longer = std::ldexp(1.0, random.between(-40, 40));
    for (glm::dvec3* v : {&camera.corner, &camera.du, &camera.dv}) *v *= longer;
  }
  return camera;
}

float float_below(const mpq_class& value) {
  auto f = static_cast<float>(value.get_d());
  while (mpq_class(f) > value) f = std::nextafter(f, -kInfinity);
  return f;
}

float float_above(const mpq_class& value) {
  auto f = static_cast<float>(value.get_d());
  while (mpq_class(f) < value) f = std::nextafter(f, kInfinity);
  return f;
}

// The boxes of a node that all hold the point at t of the ray, but for empty children at the end.
struct Boxes {
  WideNode<8> node{};
  std::size_t children;
  float greatest = 0.0f;

  Boxes(Random& random, const Ray& ray, double t) : children(static_cast<std::size_t>(random.between(1, 8))) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<glm::vec3::length_type>(axis);
      const mpq_class at = mpq_class(ray.origin[k]) + mpq_class(t) * mpq_class(ray.direction[k]);
      const float lo = float_below(at), hi = float_above(at);
      for (std::size_t child = 0; child < 8; ++child) {
        float& low = node.bounds[2 * axis][child];
        float& high = node.bounds[2 * axis + 1][child];
        low = child < children ? lo : kInfinity;
        high = child < children ? hi : -kInfinity;
        if (child == 0 || child >= children) continue;
        const float more = std::ldexp(std::fabs(hi) + std::fabs(ray.origin[k]), -random.between(-1, 26));
        if (random.one_in(3)) low -= more;
        if (random.one_in(3)) high += more;
        greatest = std::max({greatest, std::fabs(low), std::fabs(high)});
      }
      greatest = std::max({greatest, std::fabs(lo), std::fabs(hi)});
    }
  }
};

// The tile of the pixel, or a part of it that the pixel is at the border of.
std::array<int, 4> draw_rect(Random& random, const Camera& camera, int x, int y) {
  const int x0 = random.one_in(2) ? x : x / kTilePx * kTilePx,
            y0 = random.one_in(2) ? y : y / kTilePx * kTilePx;
  const int x1 = random.one_in(2) ? x : std::min(x0 + kTilePx, camera.width) - 1;
  const int y1 = random.one_in(2) ? y : std::min(y0 + kTilePx, camera.height) - 1;
  return {x0, y0, std::max(x, x1), std::max(y, y1)};
}

}  // namespace

TEST_SUITE("attack: tiles") {
  TEST_CASE("a box that holds what a pixel sees is kept, and its t is not overestimated") {
    Random random(41);
    int usable = 0, missed = 0, hidden = 0;
    double tightest = 0.0;
    for (int i = 0; i < hard::effort(60000); ++i) {
      const int scale = random.between(-30, 40);
      const Camera camera = draw_camera(random, scale);
      // In the middle of an odd size a component may be all rounding, of either sign.
      const bool middle = random.one_in(4);
      const int x = middle ? camera.width / 2 : random.between(0, camera.width - 1);
      const int y = middle ? camera.height / 2 : random.between(0, camera.height - 1);
      const Ray ray = camera.ray(x, y);
      const auto [x0, y0, x1, y1] = draw_rect(random, camera, x, y);
      const float longest =
          std::max({std::fabs(ray.direction.x), std::fabs(ray.direction.y), std::fabs(ray.direction.z)});
      const double away = std::ldexp(1.0 + std::fabs(double{random.unit()}), scale - random.between(-6, 26));
      const double t = away / double{longest};
      const Boxes boxes(random, ray, t);
      const Projection view(camera);
      const FrameFrustum frame(view, boxes.greatest);
      if (!frame.usable) continue;
      ++usable;
      const TileFrustum tile(frame, x0, y0, x1, y1);
      const std::uint32_t all = (1u << boxes.children) - 1;
      for (const Simd simd : simd_targets()) {
        CAPTURE(simd_name(simd));
        CAPTURE(i);
        float near[8];
        // Nothing seen yet; and something that rounds to the same depth, which may have a higher id.
        const float low = std::max(PLUMB_DISPATCH(LowOf, simd)(static_cast<float>(t)), 0.0f);
        for (const float seen : {0.0f, low}) {
          CHECK(PLUMB_DISPATCH(Meet, simd)(boxes.node, frame, tile, seen, near) == all);
          for (std::size_t child = 0; child < boxes.children; ++child) CHECK(double{near[child]} <= t);
        }
        tightest = std::max(tightest, double{near[0]} / t);
        // And it is worth it.
        if (boxes.children == 1 && low > 0.0f)
          hidden += PLUMB_DISPATCH(Meet, simd)(boxes.node, frame, tile, 1.01f * low, near) == 0 ? 1 : 0;
        const TileFrustum other(frame, x1 + 4, y1 + 4, x1 + 8, y1 + 8);
        missed += PLUMB_DISPATCH(Meet, simd)(boxes.node, frame, other, 0.0f, near) == 0 ? 1 : 0;
      }
    }
    MESSAGE("of " << usable << " views, the greatest share of t found is " << tightest);
    CHECK(tightest <= 1.0);
    CHECK(tightest > 0.99999);
    CHECK(usable > hard::effort(30000));
    CHECK(missed > usable);
    CHECK(hidden > 0);
  }
}

}  // namespace plumb::detail
#endif
