// In which pixels triangles may be seen: a vector of them at a time, in double. Included once per Highway
// target.

#if defined(PLUMB_PIXELS_SCREEN_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_SCREEN_BOUNDS_INL_H_
#undef PLUMB_PIXELS_SCREEN_BOUNDS_INL_H_
#else
#define PLUMB_PIXELS_SCREEN_BOUNDS_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "base/round-inl.h"
#include "hwy/highway.h"
#include "pixels/projection.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using SetupTag = hn::CappedTag<double, 8>;
using SetupVector = hn::Vec<SetupTag>;

constexpr double kSetupU = 0x1p-53;
constexpr double kDoubleInfinity = std::numeric_limits<double>::infinity();
// Corners of triangles that may be seen, coordinate by coordinate, and the pixels they may be seen in.
struct SetupCandidates {
  static constexpr size_t kRoom = 40;  // those of two vectors and of a third in part
  alignas(64) float corner[9][kRoom];
  alignas(64) float nearest[kRoom];
  alignas(64) std::int32_t x0[kRoom], y0[kRoom], x1[kRoom], y1[kRoom];
  std::uint32_t index[kRoom];
  size_t count;
};

HWY_INLINE SetupVector Dot(SetupVector px, SetupVector py, SetupVector pz, const Vector3& q) {
  const SetupTag d;
  return hn::MulAdd(pz, hn::Set(d, q.z), hn::MulAdd(py, hn::Set(d, q.y), hn::Mul(px, hn::Set(d, q.x))));
}

HWY_INLINE SetupVector Norm1(SetupVector x, SetupVector y, SetupVector z) {
  return hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
}

// ---- Where on the screen.
//
// A ray that hits a triangle at t > 0 points at a convex combination p of the vertices with row_z.p > 0, at
// the screen point (row_x.p, row_y.p) / row_z.p, which is at most slack_px away from the pixel's centre. So
// - when all vertices lie behind the eye, or all beyond one side of a rectangle of pixels (px < x_low pz and
// so on, which
//   holds of p then), nothing is seen;
// - when all lie in front, p's screen point lies in the box of theirs, and 1/t = row_z.d / row_z.p is at
//   most ray_depth over the least row_z of the vertices.

// The boxes of up to 16 triangles, as SetupCandidates has them.
struct ScreenBoxes {
  alignas(64) std::int32_t x0[16], y0[16], x1[16], y1[16];
  alignas(64) float nearest[16];
};

// Pixels of the frame, both ends included.
struct PixelRect {
  std::int32_t x0, y0, x1, y1;
};

HWY_INLINE PixelRect WholeFrame(const Projection& view) { return {0, 0, view.width - 1, view.height - 1}; }

// A bit for each triangle that may be seen in `rect`, and where in it. Finite triangles only; those with a
// NaN or infinity give none. `corner` has the nine coordinates.
HWY_INLINE std::uint32_t BoundOnScreen(const Projection& view, const PixelRect& rect,
                                       const float* const corner[9], ScreenBoxes& boxes) {
  const SetupTag d;
  const hn::Rebind<float, SetupTag> df;
  const hn::Rebind<std::int32_t, SetupTag> di;
  const auto none = hn::FirstN(d, 0);
  const auto all = hn::Not(none);
  const auto zero = hn::Zero(d);
  const SetupVector infinity = hn::Set(d, kDoubleInfinity);

  auto behind = all, left = all, right = all, above = all, below = all, in_front = all;
  SetupVector box_x0 = infinity, box_y0 = infinity;
  SetupVector box_x1 = hn::Neg(infinity), box_y1 = box_x1;
  SetupVector least_depth = infinity;
  SetupVector total_size = zero;
  const SetupVector x_low = hn::Set(d, rect.x0 - view.slack_px), x_high = hn::Set(d, rect.x1 + view.slack_px);
  const SetupVector y_low = hn::Set(d, rect.y0 - view.slack_px), y_high = hn::Set(d, rect.y1 + view.slack_px);
  const SetupVector room_x = hn::Set(d, view.width + 1.0), room_y = hn::Set(d, view.height + 1.0);
  for (int v = 0; v < 3; ++v) {
    const auto coordinate = [&](int axis, double eye) HWY_ATTR {
      return hn::Sub(hn::PromoteTo(d, hn::Load(df, corner[3 * v + axis])), hn::Set(d, eye));
    };
    const SetupVector x = coordinate(0, view.eye.x), y = coordinate(1, view.eye.y),
                      z = coordinate(2, view.eye.z);
    const SetupVector size = Norm1(x, y, z);
    total_size = hn::Add(total_size, size);
    const SetupVector px = Dot(x, y, z, view.row_x), py = Dot(x, y, z, view.row_y),
                      pz = Dot(x, y, z, view.row_z);
    const SetupVector ex = hn::Mul(size, hn::Set(d, view.row_error_x));
    const SetupVector ey = hn::Mul(size, hn::Set(d, view.row_error_y));
    const SetupVector ez = hn::Mul(size, hn::Set(d, view.row_error_z));
    behind = hn::And(behind, hn::Lt(pz, hn::Neg(ez)));
    // The product with x_low or x_high, and the sum, are off by 2 u |x_high pz| and u of the result.
    const SetupVector slope = hn::MulAdd(hn::Abs(pz), hn::Set(d, 4.0 * kSetupU), ez);
    const SetupVector wide_x = hn::Mul(hn::MulAdd(room_x, slope, ex), hn::Set(d, 1.01));
    const SetupVector wide_y = hn::Mul(hn::MulAdd(room_y, slope, ey), hn::Set(d, 1.01));
    left = hn::And(left, hn::Lt(hn::NegMulAdd(x_low, pz, px), hn::Neg(wide_x)));
    right = hn::And(right, hn::Gt(hn::NegMulAdd(x_high, pz, px), wide_x));
    above = hn::And(above, hn::Lt(hn::NegMulAdd(y_low, pz, py), hn::Neg(wide_y)));
    below = hn::And(below, hn::Gt(hn::NegMulAdd(y_high, pz, py), wide_y));

    // In front with pz > 2 ez: (px +- ex) / (pz +- ez) differs from px / pz by less than
    // (ex + |px / pz| ez) / (pz - ez) <= 2 (ex + |px / pz| ez) / pz; and the quotient is off by 3 u.
    in_front = hn::And(in_front, hn::Gt(pz, hn::Add(ez, ez)));
    const SetupVector inverse = hn::Div(hn::Set(d, 1.0), pz);
    const SetupVector twice = hn::Mul(inverse, hn::Set(d, 2.02));
    const SetupVector sx = hn::Mul(px, inverse), sy = hn::Mul(py, inverse);
    const SetupVector size_x = hn::Abs(sx), size_y = hn::Abs(sy);
    const SetupVector error_x =
        hn::MulAdd(hn::MulAdd(size_x, ez, ex), twice, hn::Mul(size_x, hn::Set(d, 8.0 * kSetupU)));
    const SetupVector error_y =
        hn::MulAdd(hn::MulAdd(size_y, ez, ey), twice, hn::Mul(size_y, hn::Set(d, 8.0 * kSetupU)));
    box_x0 = hn::Min(box_x0, hn::Sub(sx, error_x));
    box_x1 = hn::Max(box_x1, hn::Add(sx, error_x));
    box_y0 = hn::Min(box_y0, hn::Sub(sy, error_y));
    box_y1 = hn::Max(box_y1, hn::Add(sy, error_y));
    least_depth = hn::Min(least_depth, hn::Sub(pz, ez));
  }
  const auto finite = hn::Lt(total_size, infinity);
  const auto outside = hn::Or(hn::Or(behind, hn::Or(left, right)), hn::Or(above, below));

  // Where a vertex is not in front the box is the rectangle. Otherwise nothing above is NaN.
  const SetupVector slack = hn::Set(d, view.slack_px);
  const auto begin = [&](SetupVector low, int rect_begin, int rect_end) HWY_ATTR {
    const SetupVector least = hn::Set(d, rect_begin);
    const SetupVector first = hn::Ceil(hn::Sub(low, slack));
    return hn::Min(hn::Max(hn::IfThenElse(in_front, first, least), least), hn::Set(d, rect_end + 1.0));
  };
  const auto end = [&](SetupVector high, int rect_begin, int rect_end) HWY_ATTR {
    const SetupVector greatest = hn::Set(d, rect_end);
    const SetupVector last = hn::Floor(hn::Add(high, slack));
    return hn::Max(hn::Min(hn::IfThenElse(in_front, last, greatest), greatest), hn::Set(d, rect_begin - 1.0));
  };
  const SetupVector x0 = begin(box_x0, rect.x0, rect.x1), x1 = end(box_x1, rect.x0, rect.x1);
  const SetupVector y0 = begin(box_y0, rect.y0, rect.y1), y1 = end(box_y1, rect.y0, rect.y1);
  hn::Store(hn::DemoteTo(di, x0), di, boxes.x0);
  hn::Store(hn::DemoteTo(di, y0), di, boxes.y0);
  hn::Store(hn::DemoteTo(di, x1), di, boxes.x1);
  hn::Store(hn::DemoteTo(di, y1), di, boxes.y1);
  // As in pixels/tile_planes-inl.h, what is beyond this differs in the rounded t too; and it becomes a float.
  const SetupVector nearest = hn::Div(hn::Set(d, view.ray_depth * (1.0 + 0x1p-20)), least_depth);
  hn::Store(RoundToFloat(df, hn::IfThenElse(in_front, nearest, infinity)), df, boxes.nearest);

  const auto seen = hn::And(hn::AndNot(outside, finite), hn::And(hn::Le(x0, x1), hn::Le(y0, y1)));
  return MaskBits(d, seen);
}

// Adds those whose bit is set; the indices count from `first`.
HWY_INLINE void AddCandidates(const float* const corner[9], const ScreenBoxes& boxes, std::uint32_t seen,
                              size_t first, SetupCandidates& to) {
  for (; seen != 0; seen &= seen - 1) {
    const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(seen);
    const size_t i = to.count++;
    for (int k = 0; k < 9; ++k) to.corner[k][i] = corner[k][lane];
    to.x0[i] = boxes.x0[lane];
    to.y0[i] = boxes.y0[lane];
    to.x1[i] = boxes.x1[lane];
    to.y1[i] = boxes.y1[lane];
    to.nearest[i] = boxes.nearest[lane];
    to.index[i] = static_cast<std::uint32_t>(first + lane);
  }
}

// Takes the first `count` away; fewer than a vector's lanes must be left.
HWY_INLINE void DropCandidates(size_t count, SetupCandidates& from) {
  const hn::Rebind<float, SetupTag> df;
  const hn::Rebind<std::int32_t, SetupTag> di;
  from.count -= count;
  if (from.count == 0) return;
  for (auto& row : from.corner) hn::Store(hn::LoadU(df, row + count), df, row);
  hn::Store(hn::LoadU(df, from.nearest + count), df, from.nearest);
  for (std::int32_t* row : {from.x0, from.y0, from.x1, from.y1})
    hn::Store(hn::LoadU(di, row + count), di, row);
  std::copy_n(from.index + count, from.count, from.index);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
