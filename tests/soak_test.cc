#include <doctest/doctest.h>
#include <algorithm>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "plumb/brute_force.h"
#include "soak/difference.h"
#include "soak/paste.h"
#include "soak/shrink.h"
#include "soak/source.h"
#include "soak/subject.h"
#include "support/effort.h"

using namespace plumb;

namespace {

// Right but in one way: which one is what `spoil` does to the list of all hits.
class Liar final : public soak::Structure {
 public:
  using Spoil = void (*)(const Ray&, std::vector<Hit>&);
  Liar(const TriangleMesh& mesh, Spoil spoil) : brute_(mesh), spoil_(spoil) {}

  Hit closest(const Ray& ray) const override {
    std::vector<Hit> hits;
    all(ray, hits);
    return hits.empty() ? Hit{} : hits.front();
  }
  bool any(const Ray& ray) const override { return closest(ray) != Hit{}; }
  void all(const Ray& ray, std::vector<Hit>& hits) const override {
    brute_.all(ray, hits);
    spoil_(ray, hits);
  }
  std::size_t first(const Ray& ray, std::span<Hit> hits) const override {
    std::vector<Hit> found;
    all(ray, found);
    const std::size_t count = std::min(found.size(), hits.size());
    std::copy_n(found.begin(), count, hits.begin());
    std::fill(hits.begin() + static_cast<std::ptrdiff_t>(count), hits.end(), Hit{});
    return count;
  }
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = closest(rays[i]);
  }
  void any(std::span<const Ray> rays, std::span<bool> hits) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = any(rays[i]);
  }
  void cast(const Camera& camera, Frame& frame) const override {
    for (std::size_t i = 0; i < frame.id.size(); ++i) {
      const auto pixel = static_cast<int>(i);
      const Hit hit = closest(camera.ray(pixel % camera.width, pixel / camera.width));
      frame.depth[i] = hit.t;
      frame.id[i] = hit.id;
    }
  }

 private:
  BruteForce brute_;
  Spoil spoil_;
};

soak::Subject liar(Liar::Spoil spoil) {
  return {"liar", "Liar(mesh)",
          [spoil](const TriangleMesh& mesh) { return std::make_unique<Liar>(mesh, spoil); }, nullptr};
}

// Ties go to the higher id.
void swap_ties(const Ray&, std::vector<Hit>& hits) {
  if (hits.size() > 1 && hits[0].t == hits[1].t) std::swap(hits[0], hits[1]);
}

// A ray along an axis is lost.
void lose_axis_rays(const Ray& ray, std::vector<Hit>& hits) {
  if (ray.direction.x == 0.0f && ray.direction.y == 0.0f) hits.clear();
}

// The first instance of the soak's list on which the subject is wrong.
soak::Shrunk first_shrunk(const soak::Subject& subject) {
  for (std::uint64_t i = 0;; ++i) {
    REQUIRE(i < 20'000);
    soak::Tally tally;
    const soak::Drawn drawn = soak::draw_instance(1, i);
    const auto difference = soak::find_difference(drawn.instance, std::span(&subject, 1), tally);
    if (difference.has_value()) return soak::shrink(drawn.instance, *difference, std::span(&subject, 1));
  }
}

}  // namespace

TEST_SUITE("soak") {
  TEST_CASE("no method differs from the oracle") {
    const std::vector<soak::Subject> subjects = soak::all_subjects();
    soak::Tally tally;
    for (std::uint64_t i = 0; i < hard::effort(std::uint64_t{600}); ++i) {
      const soak::Drawn drawn = soak::draw_instance(7, i);
      INFO(drawn.name);
      const auto difference = soak::find_difference(drawn.instance, subjects, tally);
      REQUIRE_MESSAGE(!difference.has_value(), subjects[difference->subject].name << " " << difference->text);
    }
    CHECK(tally.rays > 10'000u / hard::kEffortDivisor);
    CHECK(tally.hits > tally.rays / 5);
    CHECK(tally.frames > 60u / hard::kEffortDivisor);
    CHECK(tally.pixel_answers > tally.pixels * 5);
  }

  TEST_CASE("an instance is the same however often and in whatever order it is drawn") {
    const soak::Drawn first = soak::draw_instance(3, 41);
    soak::draw_instance(3, 42);
    const soak::Drawn again = soak::draw_instance(3, 41);
    CHECK(first.name == again.name);
    CHECK(first.instance.mesh.triangles == again.instance.mesh.triangles);
    CHECK(first.instance.rays.size() == again.instance.rays.size());
  }

  TEST_CASE("a wrong tie is found and shrunk to two triangles and one ray of simple numbers") {
    const soak::Subject subject = liar(swap_ties);
    const soak::Shrunk shrunk = first_shrunk(subject);
    CHECK(shrunk.instance.mesh.triangles.size() == 2);
    CHECK(shrunk.instance.mesh.positions.size() == 6);
    CHECK(shrunk.instance.rays.size() == 1);
    CHECK_FALSE(shrunk.instance.camera.has_value());
    int simple = 0;
    for (const glm::vec3& p : shrunk.instance.mesh.positions) {
      for (int axis = 0; axis < 3; ++axis)
        simple += std::fabs(p[axis]) <= 1.0f && p[axis] == std::round(p[axis]) ? 1 : 0;
    }
    CHECK(simple >= 6);
    const std::string test = soak::test_to_paste(shrunk, std::span(&subject, 1));
    CHECK(test.find("TEST_CASE(\"soak: liar sees (") == 0);
    CHECK(test.find("const auto structure = Liar(mesh);") != std::string::npos);
    CHECK(test.find("CHECK(structure.closest(ray) == Hit{0x") != std::string::npos);
  }

  TEST_CASE("a lost hit is found and shrunk to one triangle, which is to be seen") {
    const soak::Subject subject = liar(lose_axis_rays);
    const soak::Shrunk shrunk = first_shrunk(subject);
    CHECK(shrunk.instance.mesh.triangles.size() == 1);
    CHECK(shrunk.instance.rays.size() == 1);
    CHECK(shrunk.difference.text.find("sees nothing where there is (") == 0);
    CHECK(soak::exact_hits(shrunk.instance.mesh, shrunk.instance.rays[0]).size() == 1);
  }

  TEST_CASE("a wrong frame is shrunk without rays, and its test makes the frame") {
    const soak::Subject subject{"blind", "blind(mesh, camera, frame)", nullptr,
                                [](const TriangleMesh&, const Camera&, Frame& frame) { frame.clear(); }};
    const soak::Shrunk shrunk = first_shrunk(subject);
    CHECK(shrunk.instance.rays.empty());
    CHECK(shrunk.instance.mesh.triangles.size() == 1);
    REQUIRE(shrunk.instance.camera.has_value());
    const std::string test = soak::test_to_paste(shrunk, std::span(&subject, 1));
    CHECK(test.find("  blind(mesh, camera, frame);\n") != std::string::npos);
    CHECK(test.find("const Camera camera({") != std::string::npos);
  }
}
