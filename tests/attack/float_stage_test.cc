// Attacks the float stage's bounds (exact/filter-inl.h): a search for rays and triangles whose computed
// values are as far off as possible. Each Highway target by itself, for some fuse operations.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/float_stage_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "exact/filter-inl.h"
#include "hwy/highway.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// The values of lane 0: the edge functions, their sum, det(a, b, c) and R.
void Values(const FilterRay& ray, const TriangleBlock<4>& block, float values[6]) {
  const hn::CappedTag<float, 4> d;
  hn::Vec<decltype(d)> edge0, edge1, edge2, den, t_num, reach;
  FilterValues(d, ray, block, 0, edge0, edge1, edge2, den, t_num, reach);
  values[0] = hn::GetLane(edge0);
  values[1] = hn::GetLane(edge1);
  values[2] = hn::GetLane(edge2);
  values[3] = hn::GetLane(den);
  values[4] = hn::GetLane(t_num);
  values[5] = hn::GetLane(reach);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "attack/climb.h"
#include "attack/exact_values.h"
#include "base/simd_dispatch.h"
#include "support/effort.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Values);

using attack::Input;

struct Shares {
  double edge02 = 0.0, edge1 = 0.0, den = 0.0, t_num = 0.0;
};

// As collapse makes it of one triangle.
TriangleBlock<4> block_of(const Triangle& triangle) {
  TriangleBlock<4> block{};
  const glm::vec3 corner[3] = {triangle.v0, triangle.v1, triangle.v2};
  double extent = 0x1p-30;
  for (int v = 0; v < 3; ++v) {
    for (int axis = 0; axis < 3; ++axis) block.vertex[v][axis][0] = corner[v][axis];
    const glm::vec3 edge = corner[v] - corner[0];
    extent =
        std::max(extent, std::fabs(double{edge.x}) + std::fabs(double{edge.y}) + std::fabs(double{edge.z}));
  }
  block.extent[0] = std::nextafter(static_cast<float>(extent), std::numeric_limits<float>::infinity());
  return block;
}

// Negative where the stage claims nothing.
double shares_of(Simd simd, const Input& input, double Shares::*share) {
  float greatest = 0.0f;
  for (std::size_t i = 6; i < input.value.size(); ++i)
    greatest = std::max(greatest, std::fabs(input.value[i]));
  const Ray ray{input.origin(), 0.0f, input.direction()};
  if (!ray_is_valid(ray) || !(greatest <= std::numeric_limits<float>::max())) return -1.0;
  const FilterRay filter(ray, greatest);
  if (!(filter.edge_scale < std::numeric_limits<float>::infinity())) return -1.0;
  const Triangle triangle = input.triangle();
  const TriangleBlock<4> block = block_of(triangle);
  float values[6];
  PLUMB_DISPATCH(Values, simd)(filter, block, values);
  // In double: the bounds' own rounding is what their last hundredth is for.
  const double extent = double{block.extent[0]}, reach = double{values[5]};
  const attack::ExactValues exact(ray.origin, ray.direction, triangle);
  Shares shares;
  const double edge_error = double{filter.edge_scale} * extent * (2.0 * reach + extent);
  const auto edge_share = [&](int i) {
    return attack::share_of_bound(double{values[i]}, exact.edge[i], edge_error);
  };
  shares.edge02 = std::max(edge_share(0), edge_share(2));
  shares.edge1 = edge_share(1);
  shares.den =
      attack::share_of_bound(double{values[3]}, exact.den, double{filter.den_scale} * extent * extent);
  shares.t_num = attack::share_of_bound(double{values[4]}, exact.t_num,
                                        double{filter.depth_scale} * reach * extent * extent + 0x1p-120);
  return shares.*share;
}

double tightest(Simd simd, std::uint64_t seed, double Shares::*share) {
  hard::Random random(seed);
  double greatest = 0.0;
  // Ordinary sizes; where the extents are at their least; where products come near the greatest allowed.
  for (const int scale : {0, -28, 30}) {
    const auto draw = [&](hard::Random& r) { return attack::random_input(r, scale, 3); };
    const auto objective = [&](const Input& input) { return shares_of(simd, input, share); };
    greatest =
        std::max(greatest, attack::climb(random, hard::effort(16), hard::effort(4000), draw, objective));
  }
  return greatest;
}

}  // namespace

TEST_SUITE("attack: float stage") {
  TEST_CASE("the bounds hold on every target, and the search comes near them") {
    struct {
      std::string name;
      double Shares::*share;
      double found;  // what the search is known to reach: less says that the bound grew or it got worse
    } const bounds[] = {{"E0 and E2", &Shares::edge02, 0.2},
                        {"E1", &Shares::edge1, 0.3},
                        {"their sum", &Shares::den, 0.4},
                        {"det(a, b, c)", &Shares::t_num, 0.4}};
    std::uint64_t seed = 1;
    for (const Simd simd : simd_targets()) {
      for (const auto& bound : bounds) {
        const double share = tightest(simd, ++seed, bound.share);
        MESSAGE(std::string(simd_name(simd))
                << ", " << bound.name << ": the greatest error found is " << share << " of its bound");
        CHECK(share <= 1.0);
        CHECK(share > bound.found / hard::kEffortDivisor);
      }
    }
  }
}

}  // namespace plumb::detail
#endif
