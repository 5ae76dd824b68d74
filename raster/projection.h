#pragma once

#include "plumb/camera.h"

namespace plumb::detail {

struct Vector3 {
  double x, y, z;
};

inline Vector3 cross(const Vector3& p, const Vector3& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}
inline double dot(const Vector3& p, const Vector3& q) { return (p.x * q.x + p.y * q.y) + p.z * q.z; }
inline double norm1(const Vector3& p) {
  return (__builtin_fabs(p.x) + __builtin_fabs(p.y)) + __builtin_fabs(p.z);
}
inline double norm_max(const Vector3& p) {
  return __builtin_fmax(__builtin_fabs(p.x), __builtin_fmax(__builtin_fabs(p.y), __builtin_fabs(p.z)));
}
/// The sum of |p_k| q_k, for q >= 0: how far p.e can be from 0 when |e_k| <= q_k.
inline double dot_abs(const Vector3& p, const Vector3& q) {
  return (__builtin_fabs(p.x) * q.x + __builtin_fabs(p.y) * q.y) + __builtin_fabs(p.z) * q.z;
}

/// A camera as the rasterizer uses it. Notation: the real-valued direction of the point (x, y) of the
/// frame, with pixel centres at integers, is D(x, y) = c0 + x du + y dv; a pixel's ray is the float
/// direction d next to it.
///
/// Everything is in double, u = 2^-53.
struct Projection {
  Vector3 c0, du, dv;
  /// G: bounds |D_k| and every partial sum of it over the frame.
  Vector3 greatest;
  double greatest_max;  ///< the largest of G's components
  /// |d_k - D_k| <= offset_k: RN32 is off by 2^-24 |d_k| or, subnormal, by 2^-150; the four operations
  /// in double before it and c0's own rounding by less than 2^-49 G_k.
  Vector3 offset;
  /// G is so small or large (or NaN) that the bounds could underflow or overflow: only the exact
  /// arithmetic is used then.
  bool exact_only;

  /// Rows of the inverse of the matrix (du, dv, c0 - ...) up to a factor: a point p seen from the eye
  /// lies at x = row_x.p / row_z.p, y = row_y.p / row_z.p, in front where row_z.p has the sign that makes
  /// a pixel's own direction lie in front (row_z carries that sign).
  Vector3 row_x, row_y, row_z;
  /// |row.p computed - exact| <= row_error * |p|_1.
  double row_error_x, row_error_y, row_error_z;
  /// A pixel's ray may point this many pixels off the pixel's centre; infinite where the inverse does
  /// not exist or is too inexact, and boxes on the screen then say nothing.
  double slack_px;

  int width, height;

  explicit Projection(const Camera& camera);
};

}  // namespace plumb::detail
