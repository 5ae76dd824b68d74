// What the queries promise beside the answers themselves (agree_test holds those against the oracle).

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <span>
#include <vector>

#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "support/fp_modes.h"

using namespace plumb;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kWidths[] = {2, 4, 8};

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) * 0x1p-23f - 1.0f; }
glm::vec3 point(std::mt19937& random) { return {uniform(random), uniform(random), uniform(random)}; }

TriangleMesh soup(std::size_t count, float size, unsigned seed) {
  std::mt19937 random(seed);
  TriangleMesh mesh;
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec3 centre = point(random);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (int v = 0; v < 3; ++v) mesh.positions.push_back(centre + point(random) * size);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
  }
  return mesh;
}

std::vector<Ray> random_rays(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = point(random) * 2.0f;
    ray.direction = point(random) - ray.origin * 0.5f;
    // Every eighth along an axis, with either zero.
    if (random() % 8 == 0)
      ray.direction = {random() % 2 == 0 ? 0.0f : -0.0f, -0.0f, ray.origin.z > 0.0f ? -1.0f : 1.0f};
  }
  return rays;
}

std::vector<Hit> closest_hits(const Bvh& bvh, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  bvh.closest(rays, hits);
  return hits;
}

}  // namespace

TEST_SUITE("trace") {
  TEST_CASE("one ray at a time, in batches and in any order, the answers are the same") {
    const TriangleMesh mesh = soup(2000, 0.1f, 1);
    const std::vector<Ray> rays = random_rays(3000, 2);
    for (const int width : kWidths) {
      CAPTURE(width);
      BuildOptions options;
      options.width = width;
      const Bvh bvh(mesh, options);
      const std::vector<Hit> expected = closest_hits(bvh, rays);
      auto any = std::make_unique<bool[]>(rays.size());
      bvh.any(rays, std::span<bool>(any.get(), rays.size()));
      std::vector<Hit> all;
      std::size_t different = 0;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        bvh.all(rays[i], all);
        const Hit first = all.empty() ? Hit{} : all.front();
        different += bvh.closest(rays[i]) != expected[i] || first != expected[i] ? 1 : 0;
        different += any[i] != (expected[i].id != kNone) || bvh.any(rays[i]) != any[i] ? 1 : 0;
        different += std::is_sorted(
                         all.begin(), all.end(),
                         [](const Hit& a, const Hit& b) { return a.t < b.t || (a.t == b.t && a.id < b.id); })
                         ? 0
                         : 1;
      }
      CHECK(different == 0);
      std::vector<Ray> reversed(rays.rbegin(), rays.rend());
      std::vector<Hit> hits = closest_hits(bvh, reversed);
      std::reverse(hits.begin(), hits.end());
      CHECK(hits == expected);
      CHECK(std::count_if(expected.begin(), expected.end(), [](const Hit& h) { return h.id != kNone; }) >
            500);
    }
  }

  TEST_CASE("the caller's floating-point mode changes no answer and is given back") {
    // Small enough that subnormals are everywhere.
    TriangleMesh mesh = soup(200, 0.5f, 3);
    for (glm::vec3& p : mesh.positions) p *= 0x1p-130f;
    std::vector<Ray> rays = random_rays(500, 4);
    for (Ray& ray : rays) {
      ray.origin *= 0x1p-130f;
      ray.direction *= 0x1p-132f;
    }
    const BruteForce brute(mesh);
    std::vector<Hit> expected(rays.size());
    brute.closest(rays, expected);
    CHECK(std::count_if(expected.begin(), expected.end(), [](const Hit& h) { return h.id != kNone; }) > 100);
    for (const hard::NamedFpMode& mode : hard::kFpModes) {
      CAPTURE(mode.name);
      for (const int width : kWidths) {
        std::vector<Hit> single(rays.size());
        const std::vector<Hit> hits = hard::under_mode(mode.bits, [&] {
          BuildOptions options;
          options.width = width;
          const Bvh bvh(mesh, options);
          std::transform(rays.begin(), rays.end(), single.begin(),
                         [&](const Ray& r) { return bvh.closest(r); });
          return closest_hits(bvh, rays);
        });
        CHECK(hits == expected);
        CHECK(single == expected);
      }
    }
  }

  TEST_CASE("ids start at first_id, and those that would reach kNone are refused") {
    const TriangleMesh mesh = soup(50, 1.0f, 5);
    const std::vector<Ray> rays = random_rays(200, 6);
    const std::vector<Hit> plain = closest_hits(Bvh(mesh), rays);
    for (const int width : kWidths) {
      BuildOptions options;
      options.width = width;
      options.first_id = kNone - 50;
      const std::vector<Hit> moved = closest_hits(Bvh(mesh, options), rays);
      for (std::size_t i = 0; i < rays.size(); ++i) {
        CHECK(moved[i].t == plain[i].t);
        CHECK(moved[i].id == (plain[i].id == kNone ? kNone : plain[i].id + (kNone - 50)));
      }
      options.first_id = kNone - 49;
      CHECK_THROWS_AS(Bvh(mesh, options), Error);
    }
    CHECK_THROWS_AS(BruteForce(mesh, kNone - 49), Error);
  }

  TEST_CASE("an empty scene and scenes of one and two triangles answer") {
    const Ray ray{{0.25f, 0.25f, -1.0f}, 0.0f, {0.0f, 0.0f, 1.0f}, kInfinity};
    TriangleMesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    for (const int width : kWidths) {
      CAPTURE(width);
      BuildOptions options;
      options.width = width;
      mesh.triangles.clear();
      CHECK(Bvh(mesh, options).closest(ray) == Hit{});
      CHECK_FALSE(Bvh(mesh, options).any(ray));
      mesh.triangles = {{3, 4, 5}};
      CHECK(Bvh(mesh, options).closest(ray) == Hit{2.0f, 0});
      mesh.triangles = {{3, 4, 5}, {0, 1, 2}};
      CHECK(Bvh(mesh, options).closest(ray) == Hit{1.0f, 1});
    }
  }

  TEST_CASE("what a caller gets wrong is an Error") {
    TriangleMesh mesh = soup(4, 1.0f, 7);
    const Bvh bvh(mesh);
    std::array<Ray, 3> rays{};
    std::array<Hit, 2> hits{};
    CHECK_THROWS_AS(bvh.closest(rays, hits), Error);
    bool any[2] = {};
    CHECK_THROWS_AS(bvh.any(rays, any), Error);
    BuildOptions options;
    options.width = 3;
    CHECK_THROWS_AS(Bvh(mesh, options), Error);
    options.width = 8;
    options.threads = -1;
    CHECK_THROWS_AS(Bvh(mesh, options), Error);
    options.threads = 0;
    options.simd = Simd::Wasm;
    CHECK_THROWS_AS(Bvh(mesh, options), Error);
    options.simd = Simd::Auto;
    options.progress = [](double) { return false; };
    CHECK_THROWS_AS(Bvh(soup(20000, 0.1f, 8), options), Cancelled);
    mesh.triangles[2].y = 12;
    CHECK_THROWS_WITH_AS(Bvh{mesh}, doctest::Contains("12"), Error);
    CHECK_THROWS_AS(BruteForce{mesh}, Error);
    Frame frame(4, 4);
    const Camera camera = Camera::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40.0, 4, 5);
    CHECK_THROWS_AS(cast(bvh, camera, frame), Error);
  }

  TEST_CASE("a cast tells its progress and can be cancelled") {
    const Bvh bvh(soup(1000, 0.1f, 9));
    const Camera camera = Camera::look_at({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 40.0, 640, 360);
    Frame frame(640, 360);
    CastOptions options;
    double last = -1.0;
    bool rising = true;
    options.progress = [&](double share) {
      rising = rising && share > last && share <= 1.0;
      last = share;
      return true;
    };
    options.threads = 1;
    cast(bvh, camera, frame, options);
    CHECK(rising);
    CHECK(last > 0.9);
    options.progress = [](double) { return false; };
    CHECK_THROWS_AS(cast(bvh, camera, frame, options), Cancelled);
  }
}
