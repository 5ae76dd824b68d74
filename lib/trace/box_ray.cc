#include "trace/box_ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace plumb::detail {

ExactBoxRay::ExactBoxRay(const Ray& ray) : tmin_(ray.tmin > 0.0f ? double{ray.tmin} : 0.0) {
  const float direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
  const float origin[3] = {ray.origin.x, ray.origin.y, ray.origin.z};
  for (int axis = 0; axis < 3; ++axis) {
    origin_[axis] = double{origin[axis]};
    parallel_[axis] = direction[axis] == 0.0f;
    // The argument of BoxRay with u = 2^-53. A float's reciprocal is at most 2^149, so nothing
    // overflows or underflows.
    const double inverse = parallel_[axis] ? 0.0 : 1.0 / double{direction[axis]};
    inv_near_[axis] = inverse * (1.0 - 0x1p-50);
    inv_far_[axis] = inverse * (1.0 + 0x1p-50);
  }
}

bool ExactBoxRay::meets(const float lo[3], const float hi[3], float limit, float& near) const {
  double nearest = tmin_;
  double farthest = double{limit};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double{lo[axis]};
    const double high = double{hi[axis]};
    if (parallel_[axis]) {
      // The ray stays in one plane, which must meet the closed box.
      if (low > origin_[axis] || high < origin_[axis]) return false;
      continue;
    }
    const bool forward = inv_near_[axis] > 0.0;
    nearest = std::max(nearest, ((forward ? low : high) - origin_[axis]) * inv_near_[axis]);
    farthest = std::min(farthest, ((forward ? high : low) - origin_[axis]) * inv_far_[axis]);
  }
  if (!(nearest <= farthest)) return false;
  near = lower_float(nearest);
  return true;
}

StayingBoxRay::StayingBoxRay(const Ray& ray, float greatest) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  // BoxRay's figures for the other axes, from a ray that moves on all of them.
  Ray moving = ray;
  for (int axis = 0; axis < 3; ++axis) {
    if (ray.direction[axis] == 0.0f) moving.direction[axis] = 1.0f;
  }
  const BoxRay box_ray(moving, greatest);
  tmin = box_ray.tmin;
  int staying = 0;
  for (int axis = 0; axis < 3; ++axis) {
    origin_near[axis] = origin_far[axis] = box_ray.origin[axis];
    inv_near[axis] = box_ray.inv_near[axis];
    inv_far[axis] = box_ray.inv_far[axis];
    near_row[axis] = box_ray.near_row[axis];
    far_row[axis] = box_ray.far_row[axis];
    if (ray.direction[axis] != 0.0f) continue;
    ++staying;
    origin_near[axis] = std::nextafter(box_ray.origin[axis], kInfinity);
    origin_far[axis] = std::nextafter(box_ray.origin[axis], -kInfinity);
    inv_near[axis] = inv_far[axis] = kInfinity;
  }
  in_range = box_ray.in_range && staying != 0;
}

template <int W>
std::uint32_t meet_children(const WideNode<W>& node, const ExactBoxRay& ray, float limit, float* near) {
  std::uint32_t met = 0;
  for (int i = 0; i < W; ++i) {
    const float lo[3] = {node.bounds[0][i], node.bounds[2][i], node.bounds[4][i]};
    const float hi[3] = {node.bounds[1][i], node.bounds[3][i], node.bounds[5][i]};
    if (node.child[i] != kNoChild && ray.meets(lo, hi, limit, near[i])) met |= 1u << i;
  }
  return met;
}

template std::uint32_t meet_children<4>(const WideNode<4>&, const ExactBoxRay&, float, float*);
template std::uint32_t meet_children<8>(const WideNode<8>&, const ExactBoxRay&, float, float*);

}  // namespace plumb::detail
