#pragma once

#include <cstdint>

#include "plumb/ray.h"

namespace plumb::detail {

/// A ray for the fast arithmetic: no bound, no second opinion. Its slabs are those of Embree's fast mode
/// (Wald et al. 2014, "Embree: A Kernel Framework for Efficient CPU Ray Tracing").
struct FastRay {
  float origin[3];
  float direction[3];
  float inverse[3];           ///< of the direction; at most the greatest float, so that no product is NaN
  std::uint32_t near_row[3];  ///< rows of WideNode::bounds
  std::uint32_t far_row[3];
  float tmin;  ///< max(tmin, 0)

  /// BoxRay's slack, which this test has not.
  static constexpr float kUnderflow = 0.0f;

  /// The ray must be valid.
  explicit FastRay(const Ray& ray);

  float near_origin(int axis) const { return origin[axis]; }
  float far_origin(int axis) const { return origin[axis]; }
  float near_inverse(int axis) const { return inverse[axis]; }
  float far_inverse(int axis) const { return inverse[axis]; }
};

}  // namespace plumb::detail
