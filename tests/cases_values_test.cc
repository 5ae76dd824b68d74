#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "cases_util.h"

// Shapes, depths, coincidence, ranges and trees: that each of these hard cases is what it says.

using namespace plumb;
using namespace plumb::cases;
using witness::Facts;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

glm::dvec3 cross(const glm::dvec3& p, const glm::dvec3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

double length(const glm::dvec3& v) { return std::sqrt(v.x * v.x + v.y * v.y + v.z * v.z); }

// The longest edge over the height above it; coordinates of cases about shape are exact in double.
double aspect(const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2) {
  const double longest = std::max({length(v1 - v0), length(v2 - v1), length(v0 - v2)});
  return longest * longest / length(cross(v1 - v0, v2 - v0));
}

float greatest(const glm::vec3& v) { return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)}); }

bool is_degenerate(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  using namespace witness;
  const Integer3 a = integers(v0);
  return is_zero(cross(difference(integers(v1), a), difference(integers(v2), a)));
}

mpq_class power_of_two(int exponent) {
  mpz_class power = 1;
  power <<= static_cast<mp_bitcnt_t>(std::abs(exponent));
  return exponent < 0 ? mpq_class(1) / mpq_class(power) : mpq_class(power);
}

// Whether a float and the next one up are equally far from the depth of some triangle.
bool at_midpoint(const Instance& instance, const Ray& ray) {
  return any_fact(instance, ray, [](const Facts& facts) {
    const std::optional<mpq_class> t = facts.depth();
    if (!t || *t <= 0) return false;
    const float f = static_cast<float>(t->get_d());  // a double holds a midpoint of normal floats exactly
    const float below = mpq_class(f) < *t ? f : std::nextafter(f, 0.0f);
    return mpq_class(below) + mpq_class(std::nextafter(below, kInf)) == 2 * *t;
  });
}

// Whether ids 0 and 1 are hit first, at one rounded depth; the exact depth of 0 is the greater one or not.
bool ties(const Instance& instance, const Ray& ray, bool lower_id_behind) {
  const std::vector<oracle::Hit> hits = all_hits(instance, ray);
  if (hits.size() < 2 || hits[0].t != hits[1].t) return false;
  const std::vector<Facts> facts = witness::all_facts(ray, instance.mesh);
  return lower_id_behind ? *facts[0].depth() > *facts[1].depth() : *facts[0].depth() < *facts[1].depth();
}

// Whether `limit` is a depth of a triangle or the float before it.
bool at_a_hit(const Instance& instance, Ray ray, float limit) {
  ray.tmin = 0.0f;
  ray.tmax = kInf;
  for (const oracle::Hit& hit : all_hits(instance, ray)) {
    if (hit.t == limit || std::nextafter(hit.t, 0.0f) == limit) return true;
  }
  return false;
}

double distance_in_sizes(const Instance& instance) {
  glm::dvec3 low(1e30), high(-1e30);
  for (const glm::vec3& v : instance.mesh.positions) {
    for (int i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], double{v[i]});
      high[i] = std::max(high[i], double{v[i]});
    }
  }
  return length(glm::dvec3(instance.camera->eye) - 0.5 * (low + high)) / length(high - low);
}

using Box = std::array<float, 6>;

Box box_of(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
  Box box;
  for (int i = 0; i < 3; ++i) {
    box[static_cast<std::size_t>(i)] = std::min({v0[i], v1[i], v2[i]});
    box[static_cast<std::size_t>(i) + 3] = std::max({v0[i], v1[i], v2[i]});
  }
  return box;
}

}  // namespace

TEST_CASE("cases: slivers, specks and strips are as thin as they say") {
  const auto thinner_than = [](double limit) {
    return [=](const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
      return aspect(v0, v1, v2) > limit;
    };
  };
  CHECK(triangle_share("sliver", thinner_than(1e3)) > 0.95);
  CHECK(triangle_share("sliver", thinner_than(1e6)) > 0.2);
  // A share of a hundredth shows only in many instances.
  if (hard::kEffortDivisor == 1) CHECK(triangle_share("sliver", thinner_than(1e7)) > 0.01);
  CHECK(ray_share("sliver", is_hit) > 0.5);
  CHECK(triangle_share("thin-diagonal", thinner_than(1e3)) > 0.8);
  CHECK(pixel_share("thin-diagonal", is_hit) > 0.05);
  // Pixels are 2^-5 wide at distance 1; specks lie at distances 1 to 3 or a little more.
  CHECK(triangle_share("speck", [](const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
          return std::max({length(v1 - v0), length(v2 - v1), length(v0 - v2)}) < 0.003 * 0x1p-5;
        }) > 0.9);
  CHECK(pixel_share("speck", is_hit) > 0.02);
}

TEST_CASE("cases: degenerate triangles have exactly no area") {
  CHECK(triangle_share("zero-area", is_degenerate) > 0.75);
  CHECK(triangle_share("point", [](const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
          return v0 == v1 && v1 == v2;
        }) > 0.8);
}

TEST_CASE("cases: depths tie after rounding and not before") {
  const auto behind = [](const Instance& i, const Ray& ray) { return ties(i, ray, true); };
  const auto in_front = [](const Instance& i, const Ray& ray) { return ties(i, ray, false); };
  CHECK(ray_share("tie-lower-id-behind", behind) == 1.0);
  CHECK(pixel_share("tie-lower-id-behind", behind) == 1.0);
  CHECK(ray_share("tie-lower-id-in-front", in_front) == 1.0);
  CHECK(pixel_share("tie-lower-id-in-front", in_front) == 1.0);
}

TEST_CASE("cases: depths lie exactly at midpoints, at the overflow and among subnormals") {
  CHECK(ray_share("depth-midpoint", at_midpoint) == 1.0);
  CHECK(pixel_share("depth-midpoint", at_midpoint) == 1.0);
  const mpq_class limit = power_of_two(128) - power_of_two(103);
  const auto near_limit = [&](const Instance& instance, const Ray& ray) {
    return any_fact(instance, ray,
                    [&](const Facts& facts) { return abs(*facts.depth() - limit) <= 2 * power_of_two(103); });
  };
  const auto exactly = [&](const Instance& instance, const Ray& ray) {
    return any_fact(instance, ray, [&](const Facts& facts) { return *facts.depth() == limit; });
  };
  CHECK(ray_share("depth-overflow", near_limit) == 1.0);
  CHECK(ray_share("depth-overflow", exactly) > 0.15);
  CHECK(ray_share("depth-overflow", is_hit) > 0.3);
  CHECK(ray_share("depth-overflow", is_hit) < 0.7);
  CHECK(ray_share("depth-subnormal", [](const Instance& instance, const Ray& ray) {
          const std::vector<oracle::Hit> hits = all_hits(instance, ray);
          return !hits.empty() && hits.back().t < 0x1p-126f;
        }) > 0.8);
}

TEST_CASE("cases: rays are limited exactly at hits") {
  CHECK(ray_share("tmin-at-hit",
                  [](const Instance& i, const Ray& ray) { return at_a_hit(i, ray, ray.tmin); }) == 1.0);
  CHECK(ray_share("tmax-at-hit",
                  [](const Instance& i, const Ray& ray) { return at_a_hit(i, ray, ray.tmax); }) == 1.0);
}

TEST_CASE("cases: surfaces coincide, or cross within a few floats") {
  const auto tied = [](const Instance& instance, const Ray& ray) {
    const std::vector<oracle::Hit> hits = all_hits(instance, ray);
    return hits.size() >= 2 && hits[0].t == hits[1].t;
  };
  CHECK(ray_share("coincident", tied) > 0.9);
  CHECK(ray_share("coplanar", tied) > 0.2);
  CHECK(pixel_share("coplanar", tied) > 0.05);
  CHECK(ray_share("duplicates", [](const Instance& instance, const Ray& ray) {
          const std::vector<oracle::Hit> hits = all_hits(instance, ray);
          std::map<float, int> counts;
          int most = 0;
          for (const oracle::Hit& hit : hits) most = std::max(most, ++counts[hit.t]);
          return most >= 1000;
        }) > 0.95);
  CHECK(ray_share("interpenetrating", [](const Instance& instance, const Ray& ray) {
          const std::vector<oracle::Hit> hits = all_hits(instance, ray);
          return hits.size() >= 2 && hits[1].t - hits[0].t <= 32 * 0x1p-23f;
        }) == 1.0);
}

TEST_CASE("cases: cameras are as far away as they say") {
  const std::pair<std::string_view, double> kCases[] = {
      {"camera-1e3", 1e3}, {"camera-1e4", 1e4}, {"camera-1e5", 1e5}, {"camera-1e6", 1e6}};
  for (const auto& place : kCases) {
    const std::string_view name = place.first;
    const double distance = place.second;
    CAPTURE(name);
    CHECK(instance_share(name, [&, far = distance](const Instance& instance) {
            const double sizes = distance_in_sizes(instance);
            return sizes > 0.15 * far && sizes < 5 * far;
          }) == 1.0);
    CHECK(pixel_share(name, is_hit) > 0.05);
  }
}

TEST_CASE("cases: values reach the ends of the floats' range and beyond") {
  const auto greatest_of = [](const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
    return std::max({greatest(v0), greatest(v1), greatest(v2)});
  };
  CHECK(triangle_share("huge-coordinates", [&](auto&... v) { return greatest_of(v...) > 0x1p125f; }) > 0.9);
  CHECK(triangle_share("subnormal-coordinates", [&](auto&... v) { return greatest_of(v...) < 0x1p-125f; }) ==
        1.0);
  CHECK(instance_share("mixed-scales", [](const Instance& instance) {
          float least = kInf, most = 0.0f;
          for (const glm::vec3& v : instance.mesh.positions) {
            least = std::min(least, greatest(v));
            most = std::max(most, greatest(v));
          }
          return most > 0x1p20f * least;
        }) > 0.9);
  CHECK(ray_share("huge-direction", [](const Instance&, const Ray& ray) {
          return greatest(ray.direction) >= 0x1p110f;
        }) > 0.95);
  CHECK(ray_share("subnormal-direction", [](const Instance&, const Ray& ray) {
          return greatest(ray.direction) < 0x1p-126f;
        }) == 1.0);
  CHECK(ray_share("subnormal-direction", is_hit) > 0.3);
  CHECK(pixel_share("extreme-camera", [](const Instance&, const Ray& ray) {
          const float size = greatest(ray.direction);
          return size < 0x1p-100f || !(size < 0x1p100f);
        }) > 0.2);
  CHECK(ray_share("non-finite-ray", [](const Instance&, const Ray& ray) {
          return !oracle::can_see(witness::to_oracle(ray));
        }) == 1.0);
  CHECK(
      triangle_share("non-finite-vertex", [](const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
        const float sum = greatest(v0 - v0) + greatest(v1 - v1) + greatest(v2 - v2);
        return !(sum == 0.0f);
      }) > 0.2);
}

TEST_CASE("cases: centroids are all equal, boxes are all equal, triangles are counted") {
  CHECK(triangle_share("equal-centroids", [](const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
          return v0 + v1 + v2 == glm::vec3(0.0f);
        }) == 1.0);
  CHECK(triangle_share("equal-boxes", [](const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
          return box_of(v0, v1, v2) == Box{-1, -1, -1, 1, 1, 1};
        }) == 1.0);
  const std::pair<std::string_view, std::size_t> kCounts[] = {
      {"no-triangle", 0}, {"one-triangle", 1}, {"two-triangles", 2}};
  for (const auto& [name, count] : kCounts) {
    CHECK(instance_share(name, [&, expected = count](const Instance& instance) {
            return instance.mesh.triangles.size() == expected;
          }) == 1.0);
  }
}
