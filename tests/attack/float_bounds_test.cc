// Attacks the places of vertices on the screen found in float (pixels/float_bounds-inl.h): a search for
// cameras and vertices whose place, or depth along the view, is as far off as possible. Each Highway target
// by itself.

#include "pixels/projection.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/float_bounds_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "pixels/float_bounds-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// What ProjectInFloat says of one vertex: sx, sy, their errors, pz, ez, |p|_1.
void Project(const FloatRows& rows, const float vertex[3], float to[7]) {
  const hn::CappedTag<float, 16> d;
  const auto of = [&](int axis) HWY_ATTR { return hn::Set(d, vertex[axis]); };
  hn::Vec<decltype(d)> sx, sy, error_x, error_y, pz, ez, size;
  ProjectInFloat(d, rows, of(0), of(1), of(2), sx, sy, error_x, error_y, pz, ez, size);
  to[0] = hn::GetLane(sx);
  to[1] = hn::GetLane(sy);
  to[2] = hn::GetLane(error_x);
  to[3] = hn::GetLane(error_y);
  to[4] = hn::GetLane(pz);
  to[5] = hn::GetLane(ez);
  to[6] = hn::GetLane(size);
}

// The box of one triangle, and the bound of its 1/t; false where it is said to be unseen.
bool Bound(const Projection& view, const float corner[9], std::int32_t box[4], float& nearest) {
  alignas(64) float row[9][16] = {};
  const float* rows[9];
  for (int k = 0; k < 9; ++k) {
    row[k][0] = corner[k];
    rows[k] = row[k];
  }
  ScreenBoxes boxes{};
  const bool seen = BoundTriangles<16>(view, WholeFrame(view), rows, 1, boxes) != 0;
  box[0] = boxes.x0[0];
  box[1] = boxes.y0[0];
  box[2] = boxes.x1[0];
  box[3] = boxes.y1[0];
  nearest = boxes.nearest[0];
  return seen;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "base/simd_dispatch.h"
#include "exact/intersect.h"
#include "support/effort.h"
#include "support/random.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Project);
HWY_EXPORT(Bound);

using hard::Random;

struct Rational3 {
  mpq_class x, y, z;
};

Rational3 exact(const glm::dvec3& v) { return {mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)}; }

Rational3 cross(const Rational3& p, const Rational3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

mpq_class dot(const Rational3& p, const Rational3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// A point's place on the screen, in pixels: p = z (c0 + x du + y dv).
struct ExactPlace {
  mpq_class x, y, z;
};

ExactPlace exact_place(const Camera& camera, const glm::vec3& point) {
  const Rational3 du = exact(camera.du), dv = exact(camera.dv), corner = exact(camera.corner);
  const mpq_class half(1, 2);
  const Rational3 c0{corner.x + half * (du.x + dv.x), corner.y + half * (du.y + dv.y),
                     corner.z + half * (du.z + dv.z)};
  const Rational3 eye = exact(glm::dvec3(camera.eye)), at = exact(glm::dvec3(point));
  const Rational3 p{at.x - eye.x, at.y - eye.y, at.z - eye.z};
  const Rational3 normal = cross(du, dv);
  const mpq_class determinant = dot(c0, normal);
  ExactPlace place;
  place.z = dot(normal, p) / determinant;
  if (place.z == 0) return place;
  place.x = dot(cross(dv, c0), p) / determinant / place.z;
  place.y = dot(cross(c0, du), p) / determinant / place.z;
  return place;
}

double share(double computed, const mpq_class& exact_value, double bound) {
  if (!(bound < std::numeric_limits<double>::infinity())) return -1.0;
  const mpq_class ratio = abs(mpq_class(computed) - exact_value) / mpq_class(bound);
  return ratio.get_d();
}

struct Input {
  Camera camera;
  glm::vec3 point;
};

Input draw(Random& random) {
  const int width = random.between(1, 4000), height = random.between(1, 4000);
  const glm::vec3 eye = random.unit3() * 4.0f;
  const glm::vec3 target = random.unit3();
  const double degrees = random.one_in(2) ? 60.0 : 0.2;
  const Camera camera = Camera::look_at(eye, target, {0.01f, 1.0f, 0.02f}, degrees, width, height);
  const Ray ray = camera.ray(random.between(0, width), random.between(0, height));
  const float depth = std::ldexp(1.0f + random.unit(), random.between(-10, 10));
  return {camera, ray.origin + depth * ray.direction};
}

// Of its bound: the error on the screen, or -1 where nothing is said.
double share_of(Simd simd, const Input& input) {
  const Projection view(input.camera);
  if (!view.rows.usable) return -1.0;
  const float vertex[3] = {input.point.x, input.point.y, input.point.z};
  float found[7];
  PLUMB_DISPATCH(Project, simd)(view.rows, vertex, found);
  if (!(found[4] > 16.0f * found[5])) return -1.0;
  const ExactPlace place = exact_place(input.camera, input.point);
  if (place.z <= 0) return std::numeric_limits<double>::infinity();  // it was said to lie in front
  return std::max(share(double{found[0]}, place.x, double{found[2]}),
                  share(double{found[1]}, place.y, double{found[3]}));
}

double tightest(Simd simd, Random& random) {
  double greatest = -1.0;
  for (int start = 0; start < hard::effort(60); ++start) {
    Input best = draw(random);
    double share_of_best = share_of(simd, best);
    for (int step = 0; step < hard::effort(300); ++step) {
      Input next = best;
      const int axis = random.between(0, 2);
      if (random.one_in(3)) {
        next.camera.eye[axis] = std::nextafter(next.camera.eye[axis], random.one_in(2) ? 99.0f : -99.0f);
      } else {
        next.point[axis] += std::ldexp(next.point[axis], -random.between(4, 24));
      }
      const double share_of_next = share_of(simd, next);
      if (share_of_next < share_of_best) continue;
      best = next;
      share_of_best = share_of_next;
    }
    greatest = std::max(greatest, share_of_best);
  }
  return greatest;
}

}  // namespace

TEST_SUITE("attack: boxes of pixels in float") {
  TEST_CASE("the bounds hold on every target, and the search comes near them") {
    for (const Simd simd : simd_targets()) {
      Random random(1);
      const double greatest = tightest(simd, random);
      MESSAGE(std::string(simd_name(simd))
              << ": the greatest error found is " << greatest << " of its bound");
      CHECK(greatest <= 1.0);
      CHECK(greatest > 0.2 / hard::kEffortDivisor);
    }
  }

  TEST_CASE("no pixel outside a box sees the triangle, and none sees it nearer than the bound") {
    Random random(7);
    std::size_t seen = 0;
    for (int i = 0; i < hard::effort(3000); ++i) {
      const int width = random.between(1, 40), height = random.between(1, 40);
      const glm::vec3 eye = random.unit3() * 4.0f;
      const double degrees = random.one_in(2) ? 60.0 : 0.2;
      const Camera camera =
          Camera::look_at(eye, random.unit3(), {0.01f, 1.0f, 0.02f}, degrees, width, height);
      // Corners near, or exactly on, rays of pixels; some behind the eye.
      glm::vec3 corner[3];
      float flat[9];
      for (int v = 0; v < 3; ++v) {
        const Ray ray = camera.ray(random.between(-3, width + 3), random.between(-3, height + 3));
        const float depth = std::ldexp(1.0f + random.unit(), random.between(-6, 6));
        corner[v] = ray.origin + (random.one_in(8) ? -depth : depth) * ray.direction;
        for (int axis = 0; axis < 3; ++axis) flat[3 * v + axis] = corner[v][axis];
      }
      const Projection view(camera);
      for (const Simd simd : simd_targets()) {
        std::int32_t box[4] = {};
        float nearest = 0;
        const bool found = PLUMB_DISPATCH(Bound, simd)(view, flat, box, nearest);
        for (int y = 0; y < height; ++y) {
          for (int x = 0; x < width; ++x) {
            const Ray ray = camera.ray(x, y);
            float t = 0;
            if (!line_hit(ray.origin, ray.direction, {corner[0], corner[1], corner[2]}, t) || !(t > 0))
              continue;
            ++seen;
            const bool inside = found && x >= box[0] && x <= box[2] && y >= box[1] && y <= box[3];
            CHECK(inside);
            CHECK(double{t} * double{nearest} >= 1.0);
          }
        }
      }
    }
    CHECK(seen > 1000);
  }
}

}  // namespace plumb::detail
#endif
