// The span calls choose packets of rays by themselves (trace/span-inl.h); what goes together must not change
// an answer. Compared with the binary tree's, which takes rays one at a time (agree_test holds it against the
// oracle).

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "support/effort.h"
#include "support/hard_rays.h"

using namespace plumb;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Answers {
  std::vector<Hit> closest;
  std::unique_ptr<bool[]> any;

  explicit Answers(std::size_t count) : closest(count), any(std::make_unique<bool[]>(count)) {}
};

Answers together(const Structure& structure, std::span<const Ray> rays) {
  Answers answers(rays.size());
  structure.closest(rays, answers.closest);
  structure.any(rays, std::span<bool>(answers.any.get(), rays.size()));
  return answers;
}

Answers one_by_one(const Structure& structure, std::span<const Ray> rays) {
  Answers answers(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) {
    answers.closest[i] = structure.closest(rays[i]);
    answers.any[i] = structure.any(rays[i]);
  }
  return answers;
}

// 16 rays about a hard one: from its origin or a few floats off, a few floats or a hundredth apart.
void add_bundle(hard::Random& random, const Ray& ray, std::vector<Ray>& rays) {
  const bool common = random.one_in(2);
  const bool narrow = random.one_in(2);
  const auto moved = [&](const glm::vec3& v) {
    if (narrow) return hard::nudged(random, v, 3);
    return v * glm::vec3(1.0f + 0.01f * random.unit(), 1.0f + 0.01f * random.unit(),
                         1.0f + 0.01f * random.unit());
  };
  for (int i = 0; i < 16; ++i) {
    Ray other = ray;
    if (i != 5) other.direction = moved(ray.direction);
    if (!common && i != 5) other.origin = moved(ray.origin);
    rays.push_back(other);
  }
}

// Makes some rays ones that see nothing, or not far.
void spoil_some(hard::Random& random, std::vector<Ray>& rays) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (Ray& ray : rays) {
    if (!random.one_in(6)) continue;
    switch (random.below(7)) {
      case 0:
        ray.tmax = 0.0f;
        break;
      case 1:
        ray.tmax = -kInfinity;
        break;
      case 2:
        ray.tmin = kInfinity;
        break;
      case 3:
        ray.tmax = kNan;
        break;
      case 4:
        ray.tmin = -0.0f;
        break;
      case 5:
        ray.tmax = random.unit() + 1.0f;
        break;
      default:
        ray.direction[random.between(0, 2)] = random.one_in(2) ? 0.0f : kNan;
    }
  }
}

void check_same(const Answers& got, const Answers& expected, std::span<const Ray> rays,
                const std::string& who) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (got.closest[i] == expected.closest[i] && got.any[i] == expected.any[i]) continue;
    CAPTURE(who);
    CAPTURE(i);
    CHECK(got.closest[i].t == expected.closest[i].t);
    CHECK(got.closest[i].id == expected.closest[i].id);
    CHECK(got.any[i] == expected.any[i]);
  }
}

}  // namespace

TEST_SUITE_BEGIN("spans");

TEST_CASE("bundles about hard rays, neighbours and strangers, see what each of their rays sees") {
  hard::Random random(31);
  for (const hard::SceneKind& kind : hard::scene_kinds()) {
    for (std::uint64_t seed = 0; seed < hard::effort(12u); ++seed) {
      const hard::Case hard_case = hard::make_case(kind, seed, 24);
      std::vector<Ray> rays;
      for (const Ray& ray : hard_case.rays) add_bundle(random, ray, rays);
      if (seed % 3 == 1) spoil_some(random, rays);
      if (seed % 3 == 2) {
        // As strangers: every 29th ray, which no 16 neighbours share an octant of.
        std::vector<Ray> apart;
        for (std::size_t i = 0; i < rays.size(); ++i) apart.push_back(rays[i * 29 % rays.size()]);
        rays = apart;
      }
      const Answers expected = one_by_one(Bvh(hard_case.mesh, {.width = 2}), rays);
      for (const int width : {4, 8}) {
        const Bvh bvh(hard_case.mesh, {.quality = static_cast<Quality>(seed % 3),
                                       .width = width,
                                       .compact = width == 8 && seed % 2 == 1});
        for (const Simd simd : simd_targets()) {
          const std::string who = std::string(kind.name) + ", seed " + std::to_string(seed) + ", bvh" +
                                  std::to_string(width) + " " + std::string(simd_name(simd));
          check_same(together(bvh.with_simd(simd), rays), expected, rays, who);
        }
      }
    }
  }
}

TEST_CASE("spans of any length, and where they are cut, change nothing") {
  const hard::SceneKind& kind = hard::kind_called(hard::scene_kinds(), "soup");
  const hard::Case hard_case = hard::make_case(kind, 3, 70);
  hard::Random random(5);
  std::vector<Ray> rays;
  for (const Ray& ray : hard_case.rays) add_bundle(random, ray, rays);
  const Bvh bvh(hard_case.mesh);
  const Answers expected = one_by_one(bvh, rays);
  for (const std::size_t length : {std::size_t{1}, std::size_t{5}, std::size_t{6}, std::size_t{15},
                                   std::size_t{17}, std::size_t{511}, std::size_t{513}, rays.size()}) {
    for (std::size_t begin = 0; begin < rays.size(); begin += length) {
      const auto part = std::span<const Ray>(rays).subspan(begin, std::min(length, rays.size() - begin));
      const Answers got = together(bvh, part);
      for (std::size_t i = 0; i < part.size(); ++i) {
        CHECK(got.closest[i] == expected.closest[begin + i]);
        CHECK(got.any[i] == expected.any[begin + i]);
      }
    }
  }
}

TEST_CASE("an empty scene and an empty span") {
  const Bvh bvh(TriangleMesh{});
  const std::vector<Ray> rays(40, Ray{{0, 0, 0}, 0.0f, {1, 1, 1}, kInfinity});
  const Answers got = together(bvh, rays);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CHECK(got.closest[i] == Hit{});
    CHECK(!got.any[i]);
  }
  bvh.closest(std::span<const Ray>(), std::span<Hit>());
}

TEST_CASE("a t that rounds to 0 is no hit, whatever the sign of tmin's zero") {
  // Found by the soak: t is 2^-273.
  const TriangleMesh mesh{{{0, 0x1p-145f, 0}, {0, 0x1p-145f, -0x1p-145f}, {0, 0, 0}}, {{0, 1, 2}}};
  for (const float tmin : {0.0f, -0.0f, -1.0f}) {
    const Ray ray{{0x1p-146f, 0x1p-145f, -0x1.8p-146f}, tmin, {-0x1p+127f, -1.0f, 1.0f}, kInfinity};
    for (const Simd simd : simd_targets()) {
      CHECK(!BruteForce(mesh).with_simd(simd).any(ray));
      CHECK(!Bvh(mesh).with_simd(simd).any(ray));
      CHECK(Bvh(mesh).with_simd(simd).closest(ray) == Hit{});
    }
  }
}

TEST_SUITE_END();
