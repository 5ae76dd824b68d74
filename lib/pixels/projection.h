#pragma once

#include "plumb/camera.h"

namespace plumb::detail {

struct Vector3 {
  double x, y, z;
};

/// Projection's rows in float, all times one power of two, for boxes of pixels found in float
/// (pixels/float_bounds-inl.h).
struct FloatRows {
  float eye[3];
  float x[3], y[3], z[3];
  /// |row.p computed in float from float p - exact| <= error |p|_1.
  float error_x, error_y, error_z;
  float slack_px;  ///< Projection's, or a little more
  float
      ray_depth;  ///< Projection's times the power of two, with room for the rounding of t and of a division
  bool usable;    ///< the numbers are such that nothing underflows or overflows
};

/// A camera as tiles are drawn for it. Notation: the real-valued direction of the point (x, y) of the
/// frame, with pixel centres at integers, is D(x, y) = c0 + x du + y dv; a pixel's ray is the float
/// direction d next to it.
///
/// Everything is in double, u = 2^-53.
struct Projection {
  Vector3 eye;
  Vector3 c0, du, dv;
  /// Bounds every component of D and each of its partial sums over the frame.
  double greatest;
  /// |d_k - D_k| <= offset_k: RN32 is off by 2^-24 |d_k| or, subnormal, by 2^-150; the four operations
  /// in double before it and c0's own rounding by less than 2^-49 of the component's greatest value.
  Vector3 offset;
  /// Directions are so small or large (or NaN) that the bounds could underflow or overflow: only the
  /// exact arithmetic is used then.
  bool exact_only;

  /// Rows of the inverse of the matrix (du, dv, c0) up to a factor: a point p seen from the eye lies at
  /// x = row_x.p / row_z.p, y = row_y.p / row_z.p, in front where row_z.p > 0 (the rows' signs are such that
  /// the pixels' own directions lie in front).
  Vector3 row_x, row_y, row_z;
  /// |row.p computed - exact| <= row_error |p|_1.
  double row_error_x, row_error_y, row_error_z;
  /// A pixel's ray may point this many pixels off the pixel's centre; infinite where the inverse does
  /// not exist or is too inexact, and the rows then say nothing.
  double slack_px;
  /// At least row_z.d for the ray d of any pixel.
  double ray_depth;

  int width, height;

  FloatRows rows;

  explicit Projection(const Camera& camera);
};

}  // namespace plumb::detail
