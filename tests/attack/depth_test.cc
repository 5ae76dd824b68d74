// Attacks the double stages' bounds for t (exact/double_stage.h, exact/depth-inl.h): a search for
// rays and triangles whose quotient is as far off as possible, and for certain answers as near the midpoint
// of two floats as they get.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/depth_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include <glm/vec3.hpp>

#include "exact/depth-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// The quotient, its slack and whether RN32(t) is certain for one ray and the triangle with these corners.
bool Depth(const glm::vec3& eye, const glm::vec3& direction, const float corner[9], double& quotient,
           double& slack, float& t) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const auto of = [&](int k) HWY_ATTR { return hn::Set(d, double{corner[k]}); };
  const auto ray = [&](int k) HWY_ATTR { return hn::Set(d, double{k < 3 ? eye[k] : direction[k - 3]}); };
  auto q = hn::Zero(d), s = hn::Zero(d);
  TriangleQuotients(d, ray, of, q, s);
  quotient = hn::GetLane(q);
  slack = hn::GetLane(s);
  auto depth = hn::Zero(df);
  auto certain = hn::FirstN(df, 0);
  TriangleDepths(d, ray, of, depth, certain);
  t = hn::GetLane(depth);
  return hn::CountTrue(df, certain) != 0;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "attack/climb.h"
#include "attack/exact_values.h"
#include "base/simd_dispatch.h"
#include "exact/double_stage.h"
#include "oracle/exact.h"
#include "support/effort.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Depth);

using attack::ExactValues;
using attack::Input;

// What a stage says of an input: t is quotient +- slack, and the rounded t where that is certain.
struct Claim {
  double quotient = 0.0, slack = std::numeric_limits<double>::infinity();
  bool certain = false;
  float t = 0.0f;
};

using Stage = std::function<Claim(const Input&)>;

Claim scalar_claim(const Input& input) {
  const DoubleStage stage(input.origin(), input.direction(), input.triangle());
  Claim claim;
  double error_ulps = 0.0;
  claim.quotient = stage.depth_quotient(error_ulps);
  // A unit of the last place is at most 2^-52 of the quotient, which its relative bound of 2^-53 is about.
  claim.slack = error_ulps * 0x1p-53 * std::fabs(claim.quotient);
  claim.certain = stage.certain_depth(claim.t);
  return claim;
}

Claim vector_claim(Simd simd, const Input& input) {
  Claim claim;
  claim.certain = PLUMB_DISPATCH(Depth, simd)(input.origin(), input.direction(), &input.value[6],
                                              claim.quotient, claim.slack, claim.t);
  return claim;
}

bool is_finite(const Input& input) {
  for (const float f : input.value) {
    if (!std::isfinite(f)) return false;
  }
  return true;
}

// |quotient - t| / slack, negative where nothing is claimed. A certain answer that is not RN32(t) is
// infinite.
double quotient_share(const Stage& stage, const Input& input) {
  if (!is_finite(input)) return -1.0;
  const Claim claim = stage(input);
  const ExactValues exact(input.origin(), input.direction(), input.triangle());
  if (exact.den == 0) return claim.certain ? std::numeric_limits<double>::infinity() : -1.0;
  if (claim.certain && claim.t != oracle::nearest_float(exact.t_num, exact.den))
    return std::numeric_limits<double>::infinity();
  if (!(claim.slack < std::numeric_limits<double>::infinity()) || !(claim.slack > 0.0)) return -1.0;
  mpq_class t(exact.t_num, exact.den);
  t.canonicalize();
  const mpq_class share = abs(mpq_class(claim.quotient) - t) / mpq_class(claim.slack);
  return share.get_d();
}

// How near a certain answer's t is to the midpoint of two floats: slack / distance, at most about 1 as
// the interval must not reach it; negative where it is not certain.
double midpoint_share(const Stage& stage, const Input& input) {
  if (!is_finite(input)) return -1.0;
  const Claim claim = stage(input);
  if (!claim.certain || claim.t == 0.0f) return -1.0;
  const ExactValues exact(input.origin(), input.direction(), input.triangle());
  if (exact.den == 0 || claim.t != oracle::nearest_float(exact.t_num, exact.den))
    return std::numeric_limits<double>::infinity();
  const float towards = std::fabs(claim.quotient) > std::fabs(double{claim.t})
                            ? std::copysign(std::numeric_limits<float>::infinity(), claim.t)
                            : 0.0f;
  const double midpoint = 0.5 * (double{claim.t} + double{std::nextafter(claim.t, towards)});
  mpq_class t(exact.t_num, exact.den);
  t.canonicalize();
  const mpq_class distance = abs(mpq_class(midpoint) - t);
  if (distance == 0) return std::numeric_limits<double>::infinity();
  const mpq_class share = mpq_class(claim.slack) / distance;
  return share.get_d();
}

using Share = double (*)(const Stage&, const Input&);

double tightest(std::uint64_t seed, const Stage& stage, Share share) {
  hard::Random random(seed);
  double greatest = -1.0;
  for (const int scale : {0, -20, 30}) {
    const auto draw = [&](hard::Random& r) { return attack::random_input(r, scale, r.one_in(2) ? 3 : 12); };
    const auto objective = [&](const Input& input) { return share(stage, input); };
    greatest =
        std::max(greatest, attack::climb(random, hard::effort(10), hard::effort(2500), draw, objective));
  }
  return greatest;
}

void attack_stage(const std::string& name, std::uint64_t seed, const Stage& stage) {
  const double quotient = tightest(seed, stage, quotient_share);
  const double midpoint = tightest(seed + 1, stage, midpoint_share);
  MESSAGE(name << ": t is off by at most " << quotient << " of its bound; the nearest midpoint to a certain "
               << "answer is " << 1.0 / midpoint << " bounds away");
  CHECK(quotient <= 1.0);
  CHECK(quotient > 0.12 / hard::kEffortDivisor);
  // The exact t is within a bound of the quotient, which is more than a bound from the midpoint.
  CHECK(midpoint < std::numeric_limits<double>::infinity());
  CHECK(midpoint > (hard::kEffortDivisor == 1 ? 0.3 : 0.0));  // few climbs get nowhere near
}

}  // namespace

TEST_SUITE("attack: depths") {
  TEST_CASE("certain depths are right, and the search comes near the bounds") {
    attack_stage("scalar", 11, scalar_claim);
    for (const Simd simd : simd_targets()) {
      attack_stage(std::string(simd_name(simd)), 13,
                   [simd](const Input& input) { return vector_claim(simd, input); });
    }
  }
}

}  // namespace plumb::detail
#endif
