#include <doctest/doctest.h>
#include <algorithm>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "oracle/oracle.h"
#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/simd.h"
#include "plumb/structures.h"
#include "support/effort.h"
#include "support/fp_modes.h"
#include "support/hard_rays.h"
#include "support/oracle_adapter.h"
#include "support/print.h"

// Every structure, width and instruction set against the oracle, on small scenes made to be hard.

using namespace plumb;

namespace {

constexpr std::uint64_t kSeeds = hard::effort(std::uint64_t{12});
constexpr std::size_t kRays = 24;

// A case whose rays come with all of their hits.
struct Answered {
  hard::Case c;
  std::vector<std::vector<Hit>> hits;

  Hit closest(std::size_t i) const { return hits[i].empty() ? Hit{} : hits[i].front(); }
};

// For every ray that hits something, more rays that begin or end exactly there, or one float beside.
void add_limits_at_hits(hard::Case& c, const oracle::Scene& scene) {
  constexpr float kInf = std::numeric_limits<float>::infinity();
  const std::size_t count = c.rays.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::vector<oracle::Hit> hits = scene.all(witness::to_oracle(c.rays[i]));
    if (hits.empty()) continue;
    const float t = hits[hits.size() / 2].t;
    for (const float limit : {t, std::nextafter(t, 0.0f), std::nextafter(t, kInf)}) {
      Ray ends = c.rays[i];
      ends.tmax = limit;
      c.rays.push_back(ends);
      Ray begins = c.rays[i];
      begins.tmin = limit;
      c.rays.push_back(begins);
      c.ray_kinds.insert(c.ray_kinds.end(), {"tmax at a hit", "tmin at a hit"});
    }
  }
}

const std::vector<Answered>& answered_cases() {
  static const std::vector<Answered> answered = [] {
    std::vector<Answered> result;
    for (hard::Case& c : hard::make_cases(kSeeds, kRays)) {
      const oracle::Scene scene(witness::to_oracle(c.mesh));
      add_limits_at_hits(c, scene);
      std::vector<std::vector<Hit>> hits;
      for (const Ray& ray : c.rays) hits.push_back(witness::to_plumb(scene.all(witness::to_oracle(ray))));
      result.push_back({std::move(c), std::move(hits)});
    }
    return result;
  }();
  return answered;
}

// `structure` is a BruteForce or a Bvh over the case's mesh, its ids from 0 on.
template <typename Structure>
void check_one_by_one(const Structure& structure, const Answered& a) {
  std::vector<Hit> all{{1.0f, 1}};  // must be replaced
  for (std::size_t i = 0; i < a.c.rays.size(); ++i) {
    INFO(a.c.describe(i));
    const Ray& ray = a.c.rays[i];
    CHECK(structure.closest(ray) == a.closest(i));
    CHECK(structure.any(ray) == !a.hits[i].empty());
    structure.all(ray, all);
    CHECK(all == a.hits[i]);
    for (const std::size_t room : {std::size_t{1}, std::size_t{3}, all.size() + 2}) {
      std::vector<Hit> first(room, Hit{1.0f, 1}), expected = a.hits[i];
      expected.resize(room);
      CHECK(structure.first(ray, first) == std::min(room, all.size()));
      CHECK(first == expected);
    }
  }
}

template <typename Structure>
void check_spans(const Structure& structure, const Answered& a) {
  const std::size_t count = a.c.rays.size();
  std::vector<Hit> closest(count);
  const auto any = std::make_unique<bool[]>(count);
  structure.closest(a.c.rays, closest);
  structure.any(a.c.rays, std::span<bool>(any.get(), count));
  for (std::size_t i = 0; i < count; ++i) {
    INFO(a.c.describe(i));
    CHECK(closest[i] == a.closest(i));
    CHECK(any[i] == !a.hits[i].empty());
  }
}

template <typename Structure>
void check_queries(const Structure& structure, const Answered& a) {
  check_one_by_one(structure, a);
  check_spans(structure, a);
}

}  // namespace

TEST_SUITE("agree: queries") {
  TEST_CASE("the cases are worth it: many hits, several on one ray, equal depths") {
    std::size_t hits = 0, several = 0, ties = 0;
    for (const Answered& a : answered_cases()) {
      for (const std::vector<Hit>& all : a.hits) {
        hits += all.empty() ? 0 : 1;
        several += all.size() > 1 ? 1 : 0;
        ties += all.size() > 1 && all[0].t == all[1].t ? 1 : 0;
      }
    }
    CHECK(answered_cases().size() >= 17 * kSeeds);
    CHECK(hits > 250 * kSeeds);
    CHECK(several > 80 * kSeeds);
    CHECK(ties > 25 * kSeeds);
  }

  TEST_CASE("brute force agrees with the oracle") {
    for (const Answered& a : answered_cases()) check_queries(BruteForce(a.c.mesh), a);
  }

  TEST_CASE("trees of every width and instruction set agree with the oracle") {
    for (const Simd simd : simd_targets()) {
      for (const int width : {2, 4, 8}) {
        // The tree of two is scalar code, whatever the target.
        if (width == 2 && simd != simd_targets().front()) continue;
        BuildOptions options;
        options.width = width;
        options.simd = simd;
        CAPTURE(simd_name(simd));
        CAPTURE(width);
        for (const Answered& a : answered_cases()) check_queries(Bvh(a.c.mesh, options), a);
      }
    }
  }

  TEST_CASE("structures of every kind agree with the oracle on every instruction set") {
    for (const StructureKind kind : structure_kinds()) {
      CAPTURE(std::string(structure_kind_name(kind)));
      StructureSettings settings;
      settings.kind = kind;
      settings.threads = 1;
      for (const Answered& a : answered_cases()) {
        const Structure structure = build_structure(a.c.mesh, settings);
        for (const Simd simd : simd_targets()) {
          CAPTURE(simd_name(simd));
          check_queries(structure.with_simd(simd), a);
        }
      }
    }
  }

  TEST_CASE("the caller's flush modes and rounding direction change no answer") {
    for (const hard::NamedFpMode& mode : hard::kFpModes) {
      CAPTURE(mode.name);
      for (const Answered& a : answered_cases()) {
        const std::size_t count = a.c.rays.size();
        std::vector<Hit> closest(count);
        std::vector<std::vector<Hit>> all(count);
        hard::under_mode(mode.bits, [&] {
          const Bvh bvh(a.c.mesh);
          bvh.closest(a.c.rays, closest);
          for (std::size_t i = 0; i < count; ++i) bvh.all(a.c.rays[i], all[i]);
        });
        for (std::size_t i = 0; i < count; ++i) {
          INFO(a.c.describe(i));
          CHECK(closest[i] == a.closest(i));
          CHECK(all[i] == a.hits[i]);
        }
      }
    }
  }
}
