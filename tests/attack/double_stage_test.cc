#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "attack/climb.h"
#include "attack/exact_values.h"
#include "exact/double_stage.h"
#include "support/effort.h"

// Attacks the double stage's bounds (exact/double_stage.h): a search for inputs whose computed values are as
// far off as possible.

using namespace plumb;
using namespace plumb::attack;

namespace {

struct Shares {
  double edge = 0.0, den = 0.0, t_num = 0.0;
};

Shares shares_of(const Input& input) {
  const detail::Triangle triangle = input.triangle();
  const detail::DoubleStage stage(input.origin(), input.direction(), triangle);
  const ExactValues exact(input.origin(), input.direction(), triangle);
  Shares shares;
  const double edges[3] = {stage.edge0, stage.edge1, stage.edge2};
  for (int i = 0; i < 3; ++i) {
    shares.edge = std::max(shares.edge, share_of_bound(edges[i], exact.edge[i], stage.e_error));
  }
  shares.den = share_of_bound(stage.den, exact.den, stage.den_error);
  shares.t_num = share_of_bound(stage.t_num, exact.t_num, stage.t_num_error);
  return shares;
}

// A climb for each bound, at ordinary coordinates and near both ends of the range.
double tightest(std::uint64_t seed, double Shares::*share) {
  hard::Random random(seed);
  double greatest = 0.0;
  for (const int scale : {0, -100, 100}) {
    const auto draw = [&](hard::Random& r) { return random_input(r, scale, r.one_in(2) ? 3 : 40); };
    const auto objective = [&](const Input& input) {
      for (const float f : input.value) {
        if (!std::isfinite(f)) return -1.0;
      }
      return shares_of(input).*share;
    };
    greatest = std::max(greatest, climb(random, hard::effort(24), hard::effort(3000), draw, objective));
  }
  return greatest;
}

// `found` is what the search is known to reach: less says that the bound grew or the search got worse.
void report(const std::string& what, double share, double found) {
  MESSAGE("double stage, " << what << ": the greatest error found is " << share << " of its bound");
  CHECK(share <= 1.0);
  CHECK(share > found / hard::kEffortDivisor);
}

}  // namespace

TEST_SUITE("attack: double stage") {
  TEST_CASE("the bounds hold, and the search comes near them") {
    const double edge = tightest(1, &Shares::edge);
    const double den = tightest(2, &Shares::den);
    const double t_num = tightest(3, &Shares::t_num);
    report("edge functions", edge, 0.2);
    report("their sum", den, 0.2);
    report("det(a, b, c)", t_num, 0.2);
  }
}
