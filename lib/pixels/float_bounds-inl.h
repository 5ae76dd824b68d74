// In which pixels triangles may be seen: a vector of them at a time, in float where that can tell, else in
// double (pixels/screen_bounds-inl.h). Included once per Highway target.

#if defined(PLUMB_PIXELS_FLOAT_BOUNDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_FLOAT_BOUNDS_INL_H_
#undef PLUMB_PIXELS_FLOAT_BOUNDS_INL_H_
#else
#define PLUMB_PIXELS_FLOAT_BOUNDS_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "hwy/highway.h"
#include "pixels/projection.h"
#include "pixels/screen_bounds-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// As BoundOnScreen has it, in float. With u = 2^-24, and p a vertex seen from the eye:
//   p:       off by u of itself
//   row.p:   that, u for a row rounded to float, and 3 u for the dot product, fused or not, each of at most
//            max|row| |p|_1: 5 u of it (FloatRows's error is 5.25 u and the double row's own error)
// Where row_z.p > 16 ez, ez being its error,
//            |px/pz - exact| <= (ex + |px/pz| ez) / (pz - ez) <= 16/15 (ex + |px/pz| ez) / pz
// (1.1 below, which leaves 3 % for the roundings of the error itself); and the quotient, and the sums with
// the error and slack_px, are off by 4 u of it (8 below).
// With kLeastSize <= |p|_1 <= kGreatestSize nothing that counts underflows or overflows: FloatRows::usable
// says that the rows are of ordinary size.
constexpr float kFloatU = 0x1p-24f;
constexpr float kLeastSize = 0x1p-40f;
constexpr float kGreatestSize = 0x1p60f;
// No bound of 1/t is below this.
constexpr float kLeastNearest = 0x1p-120f;

template <class DF, class V = hn::Vec<DF>>
HWY_INLINE V FloatDot(DF d, V px, V py, V pz, const float row[3]) {
  return hn::MulAdd(pz, hn::Set(d, row[2]),
                    hn::MulAdd(py, hn::Set(d, row[1]), hn::Mul(px, hn::Set(d, row[0]))));
}

// Vertices (x, y, z) on the screen, and how far these places may be off; row_z.p, and its bound; |p|_1. The
// places say something where the vertex lies in front: pz > 16 ez.
template <class DF, class V = hn::Vec<DF>>
HWY_INLINE void ProjectInFloat(DF d, const FloatRows& rows, V x, V y, V z, V& sx, V& sy, V& error_x,
                               V& error_y, V& pz, V& ez, V& size) {
  x = hn::Sub(x, hn::Set(d, rows.eye[0]));
  y = hn::Sub(y, hn::Set(d, rows.eye[1]));
  z = hn::Sub(z, hn::Set(d, rows.eye[2]));
  size = hn::Add(hn::Add(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  const V px = FloatDot(d, x, y, z, rows.x), py = FloatDot(d, x, y, z, rows.y);
  pz = FloatDot(d, x, y, z, rows.z);
  const V ex = hn::Mul(size, hn::Set(d, rows.error_x)), ey = hn::Mul(size, hn::Set(d, rows.error_y));
  ez = hn::Mul(size, hn::Set(d, rows.error_z));
  const V inverse = hn::Div(hn::Set(d, 1.0f), pz);
  const V scale = hn::Mul(inverse, hn::Set(d, 1.1f));
  sx = hn::Mul(px, inverse);
  sy = hn::Mul(py, inverse);
  const V size_x = hn::Abs(sx), size_y = hn::Abs(sy);
  const V off = hn::Set(d, 8.0f * kFloatU);
  error_x = hn::MulAdd(hn::MulAdd(size_x, ez, ex), scale, hn::Mul(size_x, off));
  error_y = hn::MulAdd(hn::MulAdd(size_y, ez, ey), scale, hn::Mul(size_y, off));
}

// One vector of triangles; a bit in `seen` for each that may be seen, and in `open` for those of which this
// cannot tell.
template <class DF>
HWY_INLINE void BoundInFloat(DF d, const Projection& view, const PixelRect& rect,
                             const float* const corner[9], size_t lane, ScreenBoxes& boxes,
                             std::uint32_t& seen, std::uint32_t& open) {
  using V = hn::Vec<DF>;
  const hn::RebindToSigned<DF> di;
  const FloatRows& rows = view.rows;
  const V infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  const auto all = hn::Not(hn::FirstN(d, 0));
  auto plain = all, in_front = all, behind = all;
  V x_low = infinity, y_low = infinity, least = infinity;
  V x_high = hn::Neg(infinity), y_high = x_high;
  for (int v = 0; v < 3; ++v) {
    const auto coordinate = [&](int axis) HWY_ATTR { return hn::Load(d, corner[3 * v + axis] + lane); };
    V sx, sy, error_x, error_y, pz, ez, size;
    ProjectInFloat(d, rows, coordinate(0), coordinate(1), coordinate(2), sx, sy, error_x, error_y, pz, ez,
                   size);
    plain = hn::And(plain,
                    hn::And(hn::Ge(size, hn::Set(d, kLeastSize)), hn::Le(size, hn::Set(d, kGreatestSize))));
    behind = hn::And(behind, hn::Lt(pz, hn::Neg(ez)));
    in_front = hn::And(in_front, hn::Gt(pz, hn::Mul(ez, hn::Set(d, 16.0f))));
    x_low = hn::Min(x_low, hn::Sub(sx, error_x));
    x_high = hn::Max(x_high, hn::Add(sx, error_x));
    y_low = hn::Min(y_low, hn::Sub(sy, error_y));
    y_high = hn::Max(y_high, hn::Add(sy, error_y));
    least = hn::Min(least, hn::Sub(pz, ez));
  }
  const V slack = hn::Set(d, rows.slack_px);
  const auto begin = [&](V low, int first, int last) HWY_ATTR {
    const V pixel = hn::Ceil(hn::Sub(low, slack));
    return hn::Min(hn::Max(pixel, hn::Set(d, static_cast<float>(first))),
                   hn::Set(d, static_cast<float>(last + 1)));
  };
  const auto end = [&](V high, int first, int last) HWY_ATTR {
    const V pixel = hn::Floor(hn::Add(high, slack));
    return hn::Max(hn::Min(pixel, hn::Set(d, static_cast<float>(last))),
                   hn::Set(d, static_cast<float>(first - 1)));
  };
  const V x0 = begin(x_low, rect.x0, rect.x1), x1 = end(x_high, rect.x0, rect.x1);
  const V y0 = begin(y_low, rect.y0, rect.y1), y1 = end(y_high, rect.y0, rect.y1);
  const auto told = hn::And(plain, in_front);
  // Where it is not told there may be NaN.
  const auto store = [&](V side, std::int32_t* to) HWY_ATTR {
    hn::Store(hn::ConvertTo(di, hn::IfThenElseZero(told, side)), di, to + lane);
  };
  store(x0, boxes.x0);
  store(x1, boxes.x1);
  store(y0, boxes.y0);
  store(y1, boxes.y1);
  const V nearest = hn::Max(hn::Div(hn::Set(d, rows.ray_depth), least), hn::Set(d, kLeastNearest));
  hn::Store(nearest, d, boxes.nearest + lane);
  const auto met = hn::And(hn::Le(x0, x1), hn::Le(y0, y1));
  seen |= MaskBits(d, hn::And(told, met)) << lane;
  open |= MaskBits(d, hn::Not(hn::And(plain, hn::Or(in_front, behind)))) << lane;
}

// The same in double, for triangles whose bit is set: all of the vectors that hold them.
HWY_NOINLINE inline std::uint32_t BoundInDouble(const Projection& view, const PixelRect& rect,
                                                const float* const corner[9], std::uint32_t wanted,
                                                ScreenBoxes& boxes) {
  const size_t lanes = hn::Lanes(SetupTag());
  std::uint32_t seen = 0;
  for (size_t lane = 0; wanted >> lane != 0; lane += lanes) {
    const std::uint32_t here = wanted >> lane & ((1u << lanes) - 1);
    if (here == 0) continue;
    // A narrow tree's blocks end before a vector does.
    alignas(64) float copy[9][8] = {};
    const float* from[9];
    for (int k = 0; k < 9; ++k) {
      for (size_t i = 0; i < lanes; ++i) {
        if ((here >> i & 1) != 0) copy[k][i] = corner[k][lane + i];
      }
      from[k] = copy[k];
    }
    ScreenBoxes found;
    const std::uint32_t bits = here & BoundOnScreen(view, rect, from, found);
    seen |= bits << lane;
    for (std::uint32_t rest = bits; rest != 0; rest &= rest - 1) {
      const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(rest);
      boxes.x0[lane + i] = found.x0[i];
      boxes.y0[lane + i] = found.y0[i];
      boxes.x1[lane + i] = found.x1[i];
      boxes.y1[lane + i] = found.y1[i];
      boxes.nearest[lane + i] = found.nearest[i];
    }
  }
  return seen;
}

// A bit for each of the `count` triangles, at most K, that may be seen in `rect`, and where in it: finite
// ones only. `corner` has the nine coordinates, K of each, aligned for vectors.
template <int K>
HWY_INLINE std::uint32_t BoundTriangles(const Projection& view, const PixelRect& rect,
                                        const float* const corner[9], size_t count, ScreenBoxes& boxes) {
  const std::uint32_t wanted = (1u << count) - 1;
  if (HWY_UNLIKELY(!view.rows.usable)) return BoundInDouble(view, rect, corner, wanted, boxes);
  const hn::CappedTag<float, K> d;
  std::uint32_t seen = 0, open = 0;
  for (size_t lane = 0; lane < K; lane += hn::Lanes(d))
    BoundInFloat(d, view, rect, corner, lane, boxes, seen, open);
  seen &= wanted;
  open &= wanted;
  if (HWY_UNLIKELY(open != 0)) seen |= BoundInDouble(view, rect, corner, open, boxes);
  return seen;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
