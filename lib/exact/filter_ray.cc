#include "exact/filter_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::detail {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kU = 0x1p-24;

}  // namespace

FilterRay::FilterRay(const Ray& ray, float greatest)
    : origin{ray.origin.x, ray.origin.y, ray.origin.z},
      direction{ray.direction.x, ray.direction.y, ray.direction.z},
      limit(kInfinity) {
  const double d1 =
      std::fabs(double{direction[0]}) + std::fabs(double{direction[1]}) + std::fabs(double{direction[2]});
  const double d_norm = std::max(d1, 0x1p-30);
  // The stage's intermediate values are products of some of D, R, R, L, L or fewer factors; with each
  // factor raised to at least 1, the two below bound them all (L <= 6 greatest, and its clamp).
  const double reach_origin =
      std::max({std::fabs(double{origin[0]}), std::fabs(double{origin[1]}), std::fabs(double{origin[2]})});
  const double d_cap = std::max(d1, 1.0);
  const double r_cap = std::max(reach_origin + greatest, 1.0);
  const double l_cap = std::max(7.0 * double{greatest}, 1.0);
  const bool in_range = d_cap * l_cap * (2.0 * r_cap + l_cap) < 0x1p120 && r_cap * l_cap * l_cap < 0x1p120;
  edge_scale = in_range ? static_cast<float>(9.3 * kU * d_norm) : kInfinity;
  den_scale = in_range ? static_cast<float>(7.2 * kU * d_norm) : kInfinity;
  depth_scale = in_range ? static_cast<float>(8.2 * kU) : kInfinity;
}

}  // namespace plumb::detail
