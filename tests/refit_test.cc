// Bvh::refit(): answers of the mesh as it is, invariants of the tree as if it had been built so.

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "build/binned_sah.h"
#include "build/tree_check.h"
#include "build_scenes.h"
#include "build_util.h"
#include "plumb/bvh.h"
#include "plumb/cast.h"
#include "plumb/error.h"
#include "support/fp_modes.h"
#include "support/random.h"
#include "wide/collapse.h"
#include "wide/refit.h"

using namespace plumb;
using namespace plumb::detail;

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

template <typename Move>
TriangleMesh moved(TriangleMesh mesh, const Move& move) {
  for (glm::vec3& p : mesh.positions) p = move(p);
  return mesh;
}

glm::vec3 wave(const glm::vec3& p) {
  return {p.x + 0.3f * std::sin(p.y), p.y * 1.5f - 0.2f * p.z, p.z + std::cos(3.0f * p.x)};
}

std::vector<Ray> rays_at(const TriangleMesh& mesh, int count, std::uint64_t seed) {
  hard::Random random(seed);
  std::vector<glm::vec3> finite;
  for (const glm::vec3& p : mesh.positions) {
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) finite.push_back(p);
  }
  if (finite.empty()) finite.emplace_back(0.0f);
  const auto corner = [&] { return finite[random.below(static_cast<std::uint32_t>(finite.size()))]; };
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const glm::vec3 from = corner() * 1.5f + random.unit3();
    rays.push_back({from, 0.0f, corner() - from, kInfinity});
  }
  return rays;
}

void check_same(const Bvh& bvh, const TriangleMesh& mesh, const std::vector<Ray>& rays) {
  const Bvh anew(mesh);
  std::vector<Hit> hits(rays.size()), expected(rays.size());
  bvh.closest(rays, hits);
  anew.closest(rays, expected);
  CHECK(hits == expected);
  std::size_t different = 0;
  for (const Ray& ray : rays) different += bvh.any(ray) == anew.any(ray) ? 0 : 1;
  CHECK(different == 0);
  for (const glm::vec3& eye : {glm::vec3(-20, 30, -10), glm::vec3(3, 1, 4), glm::vec3(0, 0, 0)}) {
    const Camera camera = Camera::look_at(eye, {9, 0.5f, 11}, {0, 1, 0}, 60.0, 90, 70);
    Frame frame(90, 70), wanted(90, 70);
    cast(bvh, camera, frame);
    cast(Bvh(mesh, {.width = 2}), camera, wanted);
    CHECK(compare(frame, wanted).equal());
  }
  CHECK(bvh.statistics().unseen_triangles == anew.statistics().unseen_triangles);
}

template <int W>
void check_invariants(const TriangleMesh& mesh) {
  constexpr std::uint32_t kFirst = 7;
  BinnedSahOptions options;
  options.max_leaf = 8;
  options.block = W;
  const WideTree<W> built = collapse<W>(build_scenes::build(mesh, options), mesh, kFirst, 1);
  const TriangleMesh later = moved(mesh, wave);
  WideTree<W> one = built, many = built;
  const TreeAreas areas = refit(one, later, kFirst, 1);
  hard::under_mode(hard::kOddestFpMode, [&] { return refit(many, later, kFirst, 3).tests; });
  CHECK(build_scenes::joined(check_tree(one, later, kFirst, 8)) == "");
  CHECK(std::memcmp(one.nodes.data(), many.nodes.data(), one.nodes.size() * sizeof one.nodes[0]) == 0);
  if (!one.blocks.empty())
    CHECK(std::memcmp(one.blocks.data(), many.blocks.data(), one.blocks.size() * sizeof one.blocks[0]) == 0);
  CHECK(areas.looseness() == tree_areas(one).looseness());
}

}  // namespace

TEST_SUITE("refit") {
  TEST_CASE("a tree over moved triangles holds its invariants, whatever the threads and the caller's mode") {
    for (const build_scenes::Scene& scene : build_scenes::all(1500)) {
      bool finite = true;
      for (const glm::vec3& p : scene.mesh.positions)
        finite = finite && std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
                 std::fabs(p.y) < 1e30f;
      if (!finite) continue;
      CAPTURE(scene.name);
      check_invariants<4>(scene.mesh);
      check_invariants<8>(scene.mesh);
    }
  }

  TEST_CASE("answers are those of a new tree, for every width and quality, step after step") {
    const TriangleMesh mesh = build_scenes::grid(30, 2.0f, 4);
    for (const Quality quality : {Quality::Fast, Quality::Balanced, Quality::Best}) {
      for (const int width : {4, 8}) {
        Bvh bvh(mesh, {.quality = quality, .width = width});
        TriangleMesh now = mesh;
        for (std::uint64_t step = 0; step < 3; ++step) {
          now = moved(now, wave);
          bvh.refit(now);
          check_same(bvh, now, rays_at(now, 300, step));
        }
      }
    }
  }

  TEST_CASE("copies keep what they had, and other instruction sets' views as well") {
    const TriangleMesh mesh = build_scenes::grid(20, 2.0f, 4), later = moved(mesh, wave);
    Bvh bvh(mesh);
    const Bvh copy = bvh;
    const Bvh scalar = bvh.with_simd(simd_targets().back());
    bvh.refit(later);
    const std::vector<Ray> before = rays_at(mesh, 200, 1), after = rays_at(later, 200, 2);
    check_same(copy, mesh, before);
    check_same(scalar, mesh, before);
    check_same(bvh, later, after);
    check_same(bvh.with_simd(simd_targets().back()), later, after);
    Bvh other = bvh;
    bvh = Bvh(mesh);
    other.refit(mesh);  // alone now
    check_same(other, mesh, before);
  }

  TEST_CASE("triangles may stop being finite and come back") {
    const TriangleMesh mesh = build_scenes::grid(12, 2.0f, 4);
    Bvh bvh(mesh);
    TriangleMesh broken = mesh;
    for (std::size_t i = 0; i < broken.positions.size(); i += 5)
      broken.positions[i].y = i % 2 == 0 ? kInfinity : std::nanf("");
    bvh.refit(broken);
    CHECK(bvh.statistics().unseen_triangles > 100);
    check_same(bvh, broken, rays_at(broken, 300, 3));
    bvh.refit(mesh);
    check_same(bvh, mesh, rays_at(mesh, 300, 4));
    for (glm::vec3& p : broken.positions) p = glm::vec3(kInfinity);
    bvh.refit(broken);
    CHECK(bvh.closest(Ray{{0, 9, 0}, 0, {0, -1, 0}, 99}) == Hit{});
    CHECK(bvh.statistics().unseen_triangles == mesh.triangles.size());
  }

  TEST_CASE("looseness is about the tree, not about where or how large the scene is") {
    const TriangleMesh mesh = build_scenes::grid(60, 2.0f, 4);
    Bvh bvh(mesh);
    RefitReport report = bvh.refit(mesh);
    CHECK(report.looseness == doctest::Approx(1.0));
    CHECK(!report.rebuild_advised);
    report = bvh.refit(moved(mesh, [](const glm::vec3& p) { return p * 64.0f + glm::vec3(1000, -500, 3); }));
    CHECK(report.looseness == doctest::Approx(1.0).epsilon(0.01));
    // Each triangle somewhere else.
    TriangleMesh shuffled = mesh;
    for (std::size_t i = shuffled.triangles.size(); i-- > 1;)
      std::swap(shuffled.triangles[i], shuffled.triangles[i * 7919 % (i + 1)]);
    report = bvh.refit(shuffled);
    CAPTURE(report.looseness);
    CHECK(report.looseness > 5.0);
    CHECK(report.rebuild_advised);
    CHECK(bvh.statistics().sah_cost > 5.0 * Bvh(mesh).statistics().sah_cost);
    report = bvh.refit(mesh);
    CHECK(report.looseness == doctest::Approx(1.0));
  }

  TEST_CASE("what cannot be followed is an error, and changes nothing") {
    TriangleMesh mesh = build_scenes::grid(6, 2.0f, 4);
    const glm::vec3 was = mesh.positions[10];
    mesh.positions[10].x = std::nanf("");
    Bvh bvh(mesh);
    TriangleMesh later = moved(mesh, wave);
    later.positions[10] = was;
    CHECK_THROWS_WITH_AS(bvh.refit(later), doctest::Contains("build a new Bvh"), Error);
    later.positions[10].x = kInfinity;
    TriangleMesh fewer = later;
    fewer.triangles.pop_back();
    CHECK_THROWS_AS(bvh.refit(fewer), Error);
    TriangleMesh beyond = later;
    beyond.triangles[3].y = 100000;
    CHECK_THROWS_AS(bvh.refit(beyond), Error);
    CHECK_THROWS_AS(bvh.refit(later, -1), Error);
    check_same(bvh, mesh, rays_at(mesh, 100, 5));
    bvh.refit(later);
    check_same(bvh, later, rays_at(later, 100, 5));
    Bvh two(mesh, {.width = 2}), packed(mesh, {.compact = true});
    CHECK_THROWS_AS(two.refit(mesh), Error);
    CHECK_THROWS_AS(packed.refit(mesh), Error);
    Bvh empty(MeshView{});
    CHECK(empty.refit(MeshView{}).looseness == 1.0);
  }
}
