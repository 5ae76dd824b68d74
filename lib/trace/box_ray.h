#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "build/binary_tree.h"
#include "plumb/ray.h"
#include "wide/wide_tree.h"

// Boxes are culled conservatively: one that holds a point of the ray with an exact t that counts is
// never skipped. The displacement of the definition does not matter here: a hit's exact point lies
// on the closed triangle, by continuity, and so in the closed box of its vertices.

namespace plumb::detail {

/// A lower bound of a t >= 0 as a float: rounded to float it may grow by half a unit in the last place, so it
/// is taken down before. Where it is subnormal that does nothing, and it may be 2^-150 too great. That loses
/// nothing against a limit from depth_limit(), the float after the best depth b: what is above that is at
/// least b + 2 * 2^-149, so the point's t is above b + 2^-149 and rounds to more than b.
inline float lower_float(double t) { return std::max(static_cast<float>(t * (1.0 - 0x1p-23)), 0.0f); }

/// A ray against boxes in plain double arithmetic, for any valid ray: the reference, and the path for
/// rays that the float test cannot take.
class ExactBoxRay {
 public:
  explicit ExactBoxRay(const Ray& ray);

  /// Whether the box may hold a point with t from tmin to `limit`; then `near` is a lower bound of
  /// its t, at least max(tmin, 0), as lower_float() has it.
  bool meets(const float lo[3], const float hi[3], float limit, float& near) const;

 private:
  double origin_[3];
  double inv_near_[3];  // 1 / d, shrunk by its own and the slab's rounding
  double inv_far_[3];   // and grown
  bool parallel_[3];
  double tmin_;
};

/// A ray against the SoA boxes of wide nodes in float.
///
/// For a plane p of an axis, with s = (p - o) / d the exact parameter, the computed product
/// fl(fl(p - o) * inverse) has two roundings; the inverse has its own and that of the factor it carries, 1 -
/// 6 u for near planes and 1 + 6 u for far ones, u = 2^-24. The four are a relative error below 4.01 u, so
/// that where s > 0 the near value is below it and the far value above. Where s < 0, a near value is at most
/// 0 (and the comparison starts at max(tmin, 0)), and a far value is negative, as it should be: no point of
/// the box lies ahead. A product that underflows is off by up to 2^-150, which the comparison allows for
/// (kUnderflow), as does depth_limit() for a near value kept for later.
struct BoxRay {
  float origin[3];
  float inv_near[3];
  float inv_far[3];
  std::uint32_t near_row[3];  ///< rows of WideNode::bounds
  std::uint32_t far_row[3];
  float tmin;     ///< max(tmin, 0)
  bool in_range;  ///< the analysis above holds: no zero in the direction, nothing overflows

  /// Subtracted from near before it is compared with far. Absorbed when near is above 2^-96; below, it
  /// makes up for products that underflowed.
  static constexpr float kUnderflow = 0x1p-120f;

  static constexpr float kNearFactor = 1.0f - 6.0f * 0x1p-24f;
  static constexpr float kFarFactor = 1.0f + 6.0f * 0x1p-24f;

  BoxRay(const Ray& ray, float greatest)
      : origin{ray.origin.x, ray.origin.y, ray.origin.z}, tmin(ray.tmin > 0.0f ? ray.tmin : 0.0f) {
    const float direction[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
    float least = 0x1p60f, greatest_direction = 0.0f, reach = greatest;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
      const float magnitude = std::fabs(direction[axis]);
      least = std::min(least, magnitude);
      greatest_direction = std::max(greatest_direction, magnitude);
      reach = std::max(reach, std::fabs(origin[axis]));
      const float inverse = 1.0f / direction[axis];
      inv_near[axis] = inverse * kNearFactor;
      inv_far[axis] = inverse * kFarFactor;
      const std::uint32_t backward = direction[axis] > 0.0f ? 0 : 1;
      near_row[axis] = 2 * axis + backward;
      far_row[axis] = 2 * axis + (1 - backward);
    }
    // Then |p - o| < 2^62, the inverses are normal and the products below 2^124.
    in_range = least > 0x1p-60f && greatest_direction < 0x1p60f && reach < 0x1p60f;
  }

  float near_origin(int axis) const { return origin[axis]; }
  float far_origin(int axis) const { return origin[axis]; }
  float near_inverse(int axis) const { return inv_near[axis]; }
  float far_inverse(int axis) const { return inv_far[axis]; }
};

/// BoxRay for a ray whose direction is 0 on one axis or two, on which it stays at o. The inverses are
/// infinite there: a box that holds o gives -inf and +inf, any other one the same infinity twice or the wrong
/// way round, and is culled as long as the limit is finite. So that no difference is 0 for a box that holds
/// o, near planes are taken from the float above o, far ones from that below; 0 * inf is NaN, for a box that
/// begins or ends there and so does not hold o. It is culled, or kept by the other axes alone, as the
/// target's min and max have it.
struct StayingBoxRay {
  float origin_near[3], origin_far[3];
  float inv_near[3];
  float inv_far[3];
  std::uint32_t near_row[3];
  std::uint32_t far_row[3];
  float tmin;
  bool in_range;  ///< BoxRay's analysis holds on the other axes, and there is an axis to stay on

  static constexpr float kUnderflow = BoxRay::kUnderflow;

  StayingBoxRay(const Ray& ray, float greatest);

  float near_origin(int axis) const { return origin_near[axis]; }
  float far_origin(int axis) const { return origin_far[axis]; }
  float near_inverse(int axis) const { return inv_near[axis]; }
  float far_inverse(int axis) const { return inv_far[axis]; }

  /// The limit to test boxes with: above every near value but infinite ones.
  static float finite(float limit) { return std::min(limit, std::numeric_limits<float>::max()); }
};

/// The children of a node that the ray may meet, one bit each, by ExactBoxRay, with their near values.
template <int W>
std::uint32_t meet_children(const WideNode<W>& node, const ExactBoxRay& ray, float limit, float* near);

}  // namespace plumb::detail
