#pragma once

#include <cstdint>
#include "build/binary_tree.h"
#include "exact/intersect.h"

#include "plumb/ray.h"

namespace plumb::detail {

/// A ray for Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection", and boxes wide enough
/// for it.
///
/// Vertices are moved so that the origin is 0 and sheared so that the ray runs along the axis `kz`, where
/// its direction is greatest: with a = fl(v - o) and s = fl(d_k / d_kz) for the other two axes k,
///
///     x = fl(a_k - fl(s a_kz))
///
/// Every triangle at a vertex computes the same x. The sign of an edge function, of fl(fl(p) - fl(q)), is
/// the exact one of p - q or zero, for rounding is monotonic; where it is zero double decides, which
/// holds the products exactly. So the answer is that of exact arithmetic on a mesh whose vertices
/// lie elsewhere by the rounding of x, the same for all triangles: it has no cracks. With u = 2^-24
/// and |s| <= 1, x is off by
///
///     2 u |v - o|_k + 4 u |v - o|_kz + 2^-108,  to first order:
///
/// a's difference, s's quotient, the product, the last difference; s may underflow by 2^-150, times 2^41.
/// Boxes are grown by 5 u (R_k + R_kz) + 2^-100 on these axes, R being the most that |v - o| is in
/// the scene, which moves the origins of near and far planes apart, and these by 2 u |o_k| more, for they
/// are rounded. On kz nothing has moved. The rest is BoxRay's argument. An inverse is at most the greatest
/// float: where that cuts it off, near values only become less, and a far value, of at least what 5 u R_kz
/// exceeds the error by, times 2^127, lies beyond any t = R_kz / d_kz.
struct WatertightRay {
  int k[3];         ///< axes: the two that are sheared, then kz
  float origin[3];  ///< by k
  float shear[2];   ///< d_k / d_kz
  float inverse_z;  ///< 1 / d_kz: t = z / d_kz

  float box_origin_near[3], box_origin_far[3];  ///< by axis, like the rest
  float inv_near[3], inv_far[3];
  std::uint32_t near_row[3], far_row[3];
  float tmin;     ///< max(tmin, 0)
  bool in_range;  ///< the analysis holds, nothing overflows: coordinates below 2^40, d_kz beyond 2^-+60

  static constexpr float kUnderflow = 0x1p-120f;  ///< as BoxRay's

  /// `box` holds the scene's triangles, `greatest` is the greatest |coordinate| among them.
  WatertightRay(const Ray& ray, const Box& box, float greatest);

  float near_origin(int axis) const { return box_origin_near[axis]; }
  float far_origin(int axis) const { return box_origin_far[axis]; }
  float near_inverse(int axis) const { return inv_near[axis]; }
  float far_inverse(int axis) const { return inv_far[axis]; }
};

/// A sum of edge functions below this is computed again in double, lest products have underflowed.
inline constexpr float kLeastWatertightSum = 0x1p-60f;

/// The triangle's decision in double, where an edge function is zero in float. The edges belong to the
/// triangle. True for a hit, of either sign of `t`.
bool watertight_hit(const WatertightRay& ray, const Triangle& triangle, float& t);

}  // namespace plumb::detail
