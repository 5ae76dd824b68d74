// Attacks what the float stage leaves out for being too far (exact/filter_ray.h: set_limit) and the range in
// which it claims anything: searches for hits that it loses. Each Highway target by itself.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/limit_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "base/mask_bits-inl.h"
#include "exact/filter-inl.h"
#include "hwy/highway.h"
#include "wide/triangle_block.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// What the stage says of lane 0: bit 0 for possible, bit 1 for certain.
int Filter(const FilterRay& ray, const TriangleBlock<4>& block) {
  const hn::CappedTag<float, 4> d;
  hn::Mask<decltype(d)> possible, certain;
  FilterTriangles(d, ray, block, 0, possible, certain);
  return static_cast<int>((MaskBits(d, possible) & 1u) | (MaskBits(d, certain) & 1u) << 1);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "attack/climb.h"
#include "base/simd_dispatch.h"
#include "oracle/oracle.h"
#include "support/effort.h"
#include "support/oracle_adapter.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Filter);

using attack::Input;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kPossible = 1, kCertain = 2;

struct Lane {
  Ray ray;
  float greatest;
  TriangleBlock<4> block;
};

// False for an input that is none.
bool make_lane(const Input& input, Lane& lane) {
  const TriangleMesh mesh{{input.point(2), input.point(3), input.point(4)}, {{0, 1, 2}}};
  lane.ray = {input.origin(), 0.0f, input.direction(), kInfinity};
  if (!ray_is_valid(lane.ray) || !triangle_is_finite(input.triangle())) return false;
  lane.greatest = 0.0f;
  for (std::size_t i = 6; i < input.value.size(); ++i)
    lane.greatest = std::max(lane.greatest, std::fabs(input.value[i]));
  lane.block = {};
  set_triangle(lane.block, 0, mesh, 0, 0);
  return true;
}

oracle::Triangle oracle_triangle(const Input& input) {
  return {witness::to_oracle(input.point(2)), witness::to_oracle(input.point(3)),
          witness::to_oracle(input.point(4)), 0};
}

std::optional<float> exact_hit(const Input& input) {
  return oracle::line_hit(witness::to_oracle(input.origin()), witness::to_oracle(input.direction()),
                          oracle_triangle(input));
}

// By how many units of 2^-24 the least limit at which a hit is still possible exceeds the hit's t: the slack
// that set_limit must have. Negative for none.
double needed_slack(Simd simd, const Input& input) {
  Lane lane;
  if (!make_lane(input, lane)) return -1e9;
  const std::optional<float> t = exact_hit(input);
  if (!t || !(*t > 0x1p-100f) || !(*t < 0x1p100f)) return -1e9;
  FilterRay filter(lane.ray, lane.greatest);
  const auto is_possible = [&](float limit) {
    filter.limit = limit;
    return (PLUMB_DISPATCH(Filter, simd)(filter, lane.block) & kPossible) != 0;
  };
  // Between floats, whose bits are in their order.
  auto low = std::bit_cast<std::uint32_t>(0.5f * *t), high = std::bit_cast<std::uint32_t>(2.0f * *t);
  if (!is_possible(std::bit_cast<float>(high))) return std::numeric_limits<double>::infinity();
  if (is_possible(std::bit_cast<float>(low))) return -1e9;
  while (high - low > 1) {
    const std::uint32_t middle = low + (high - low) / 2;
    (is_possible(std::bit_cast<float>(middle)) ? high : low) = middle;
  }
  return (double{std::bit_cast<float>(high)} / double{*t} - 1.0) * 0x1p24;
}

}  // namespace

TEST_SUITE("attack: limits") {
  TEST_CASE("no hit that may win is too far") {
    for (const Simd simd : simd_targets()) {
      hard::Random random(31);
      const auto draw = [](hard::Random& r) { return attack::random_input(r, 0, 3); };
      const auto objective = [simd](const Input& input) { return needed_slack(simd, input); };
      const double most = attack::climb(random, hard::effort(30), hard::effort(3000), draw, objective);
      MESSAGE(std::string(simd_name(simd))
              << ": a hit needs a limit of at most " << most
              << " units of 2^-24 above its t (the bound of T's error is slack as well); set_limit gives 17");
      // The next float, and 2^-20 more.
      CHECK(most <= 17.0);
      CHECK(most > -12.0 * hard::kEffortDivisor);
    }
  }

  TEST_CASE("at the ends of the range nothing is lost and nothing is wrongly certain") {
    for (const Simd simd : simd_targets()) {
      hard::Random random(32);
      int claims = 0, silent = 0, hits = 0;
      for (int i = 0; i < hard::effort(60'000); ++i) {
        // Where products reach 2^120, where extents and directions are at their clamps, or anywhere.
        const int scale = random.one_in(2) ? random.between(36, 42) : random.between(-149, 126);
        Input input = attack::random_input(random, scale, random.between(1, 6));
        const int direction_scale = random.one_in(2) ? 0 : random.between(-149, 120) - scale;
        for (std::size_t k = 3; k < 6; ++k) input.value[k] = std::ldexp(input.value[k], direction_scale);
        Lane lane;
        if (!make_lane(input, lane)) continue;
        FilterRay filter(lane.ray, lane.greatest);
        const std::optional<float> t = exact_hit(input);
        if (t && *t > 0.0f && random.one_in(2)) filter.set_limit(*t);
        const int says = PLUMB_DISPATCH(Filter, simd)(filter, lane.block);
        claims += says != kPossible;
        silent += !(filter.edge_scale < kInfinity);
        if (t && *t > 0.0f) {
          ++hits;
          CHECK((says & kPossible) != 0);
        } else if ((says & kPossible) != 0) {
          // Certain lanes are covered: they lack a hit only because t is infinite or not above 0.
          if ((says & kCertain) != 0) {
            CHECK(oracle::line_meets(witness::to_oracle(input.origin()),
                                     witness::to_oracle(input.direction()), oracle_triangle(input)));
          }
        }
      }
      MESSAGE(std::string(simd_name(simd)) << ": " << hits << " hits; something is claimed of " << claims
                                           << " inputs, " << silent << " are out of range");
      CHECK(hits > 5'000 / static_cast<int>(hard::kEffortDivisor));
      CHECK(claims > 5'000 / static_cast<int>(hard::kEffortDivisor));
      CHECK(silent > 5'000 / static_cast<int>(hard::kEffortDivisor));
    }
  }
}

}  // namespace plumb::detail
#endif
