// Attacks the projection's bounds (pixels/projection.h): a search for cameras and pixels whose ray points as
// far from the pixel's centre as possible, and for points whose place on the screen is as far off.

#include "pixels/projection.h"

#include <doctest/doctest.h>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "support/effort.h"
#include "support/random.h"

using namespace plumb;
using plumb::detail::Projection;
using plumb::hard::Random;

namespace {

struct Rational3 {
  mpq_class x, y, z;
};

Rational3 exact(const glm::dvec3& v) { return {mpq_class(v.x), mpq_class(v.y), mpq_class(v.z)}; }
Rational3 exact(const glm::vec3& v) { return exact(glm::dvec3(v)); }

Rational3 cross(const Rational3& p, const Rational3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

mpq_class dot(const Rational3& p, const Rational3& q) { return p.x * q.x + p.y * q.y + p.z * q.z; }

// The matrix whose inverse Projection approximates, without rounding.
struct ExactRows {
  Rational3 x, y, z;

  explicit ExactRows(const Camera& camera) {
    const Rational3 du = exact(camera.du), dv = exact(camera.dv), corner = exact(camera.corner);
    const mpq_class half(1, 2);
    const Rational3 c0{corner.x + half * (du.x + dv.x), corner.y + half * (du.y + dv.y),
                       corner.z + half * (du.z + dv.z)};
    x = cross(dv, c0);
    y = cross(c0, du);
    z = cross(du, dv);
    if (dot(c0, z) < 0) {
      for (Rational3* row : {&x, &y, &z}) *row = {-row->x, -row->y, -row->z};
    }
  }
};

struct Input {
  Camera camera;
  int x, y;
  glm::vec3 point;
};

struct Shares {
  double slack = -1.0, ray_depth = -1.0, row_x = -1.0, row_y = -1.0, row_z = -1.0;
};

double share(const mpq_class& error, double bound) {
  if (error == 0) return 0.0;
  if (!(bound > 0.0)) return std::numeric_limits<double>::infinity();
  if (!(bound < std::numeric_limits<double>::infinity())) return -1.0;
  const mpq_class ratio = abs(error) / mpq_class(bound);
  return ratio.get_d();
}

Shares shares_of(const Input& input) {
  Shares shares;
  const Projection view(input.camera);
  if (!(view.slack_px < std::numeric_limits<double>::infinity())) return shares;
  const ExactRows rows(input.camera);
  const Rational3 d = exact(input.camera.ray(input.x, input.y).direction);
  const mpq_class depth = dot(rows.z, d);
  if (depth <= 0) {  // the bounds say that it lies in front
    shares.slack = std::numeric_limits<double>::infinity();
    return shares;
  }
  const mpq_class off_x = dot(rows.x, d) / depth - input.x, off_y = dot(rows.y, d) / depth - input.y;
  shares.slack = std::max(share(off_x, view.slack_px), share(off_y, view.slack_px));
  shares.ray_depth = share(depth, view.ray_depth);

  const double p[3] = {double{input.point.x} - view.eye.x, double{input.point.y} - view.eye.y,
                       double{input.point.z} - view.eye.z};
  const double size = std::fabs(p[0]) + std::fabs(p[1]) + std::fabs(p[2]);
  const Rational3 eye = exact(input.camera.eye), point = exact(input.point);
  const Rational3 seen{point.x - eye.x, point.y - eye.y, point.z - eye.z};
  const auto row_share = [&](const detail::Vector3& row, const Rational3& exact_row, double row_error) {
    const double computed = (row.x * p[0] + row.y * p[1]) + row.z * p[2];
    return share(mpq_class(computed) - dot(exact_row, seen), row_error * size);
  };
  shares.row_x = row_share(view.row_x, rows.x, view.row_error_x);
  shares.row_y = row_share(view.row_y, rows.y, view.row_error_y);
  shares.row_z = row_share(view.row_z, rows.z, view.row_error_z);
  return shares;
}

double random_double(Random& random) {
  const double high = double{random.unit()};
  const double low = double{random.unit()};
  return high + 0x1p-24 * low;
}

// As look_at makes it, or any basis: long and short, nearly flat.
Input draw(Random& random) {
  const int width = random.between(1, 4000), height = random.between(1, 4000);
  const glm::vec3 eye = random.unit3() * 4.0f;
  const glm::vec3 target = random.unit3();
  Camera camera =
      Camera::look_at(eye, target, {0.01f, 1.0f, 0.02f}, random.one_in(2) ? 60.0 : 0.2, width, height);
  if (random.one_in(2)) {
    const double scale = std::ldexp(1.0, random.between(-60, 60));
    for (glm::dvec3* v : {&camera.corner, &camera.du, &camera.dv}) {
      const double step = v == &camera.corner ? scale : scale * std::ldexp(1.0, -random.between(2, 14));
      for (int axis = 0; axis < 3; ++axis) (*v)[axis] = step * random_double(random);
    }
  }
  const int x = random.between(0, width - 1), y = random.between(0, height - 1);
  const float reach = std::ldexp(1.0f, random.between(-10, 10));
  return {camera, x, y, eye + random.unit3() * reach};
}

void mutate(Random& random, Input& input) {
  glm::dvec3* const vectors[3] = {&input.camera.corner, &input.camera.du, &input.camera.dv};
  const int which = random.between(0, 2);
  const int axis = random.between(0, 2);
  double& value = (*vectors[which])[axis];
  switch (random.below(6)) {
    case 0:
      value = std::nextafter(value, random.one_in(2) ? 1e300 : -1e300);
      break;
    case 1:
      value += std::ldexp(value, -random.between(1, 52));
      break;
    case 2:
      value = random_double(random) * std::fabs(value);
      break;
    case 3:
      input.x = random.between(0, input.camera.width - 1);
      input.y = random.between(0, input.camera.height - 1);
      break;
    case 4:
      input.point[axis] += std::ldexp(input.point[axis], -random.between(1, 23));
      break;
    default:
      value = -value;
  }
}

double tightest(std::uint64_t seed, double Shares::*which) {
  Random random(seed);
  double greatest = -1.0;
  for (int start = 0; start < hard::effort(40); ++start) {
    Input best = draw(random);
    double value = shares_of(best).*which;
    for (int step = 0; step < hard::effort(800); ++step) {
      Input changed = best;
      mutate(random, changed);
      const double reached = shares_of(changed).*which;
      if (reached >= value) {
        value = reached;
        best = changed;
      }
    }
    greatest = std::max(greatest, value);
  }
  return greatest;
}

}  // namespace

TEST_SUITE("attack: projection") {
  TEST_CASE("the bounds hold, and the search comes near them") {
    struct {
      std::string name;
      double Shares::*which;
      double found;  // what the search is known to reach: less says that the bound grew or it got worse
    } const bounds[] = {{"a ray's distance from its pixel's centre", &Shares::slack, 0.6},
                        {"a ray's depth along the axis", &Shares::ray_depth, 0.9},
                        {"the row for x", &Shares::row_x, 0.1},
                        {"the row for y", &Shares::row_y, 0.1},
                        {"the row for z", &Shares::row_z, 0.1}};
    std::uint64_t seed = 21;
    for (const auto& bound : bounds) {
      const double greatest = tightest(++seed, bound.which);
      MESSAGE(bound.name << ": the greatest found is " << greatest << " of its bound");
      CHECK(greatest <= 1.0);
      CHECK(greatest > bound.found / hard::kEffortDivisor);
    }
  }
}
