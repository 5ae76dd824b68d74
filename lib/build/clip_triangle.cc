#include "build/clip_triangle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/round.h"
#include "build/box.h"

// Sutherland and Hodgman 1974, "Reentrant Polygon Clipping", in double. That nothing is lost:
//
// Let M be the greatest |coordinate| of the triangle along an axis and u = 2^-53. Claim: after j clips,
// every point of the exact clipped triangle has a point of the computed polygon within 12 j u M of it, along
// each axis (with its own M). It holds for j = 0. A clip at plane p is made at p moved outward by slack =
// 128 u M: a point q of the exact result has a point of the polygon before within 12 j u M <= 60 u M, which
// so lies on the kept side of the moved plane (only planes that cut the triangle's own box are clipped at:
// |p| <= M, and moving it rounds by 1.01 u M). So it lies in the exact clip of that polygon, whose corners
// are old ones and crossings r = a + f (b - a), f = (p - a) / (b - a) along the clip's axis, 0 <= f <= 1. As
// computed, f has three roundings, and r three more: with |b - a| <= 2 M its error is at most 2 M (3.01
// + 2.01) u + 1.01 u M < 12 u M. What lies between the corners moves by no more than they. r is clamped
// between a and b, where the exact one is, so that all corners stay within M. Underflow is out of reach:
// differences of doubles that come from floats this way are 0 or far above 2^-900.
//
// After six clips at most the box of the corners, grown by slack, holds the exact result; and when no corner
// is left there is none.

namespace plumb::detail {
namespace {

constexpr double kSlack = 128 * 0x1p-53;

struct Polygon {
  double corner[9][3];  // a plane adds one at most
  int count;
};

// Keeps what is on the plane's side of `sign`: sign * x <= sign * plane.
void clip(const Polygon& from, int axis, double plane, double sign, Polygon& to) {
  to.count = 0;
  const double* a = from.corner[from.count - 1];
  double a_outside = (a[axis] - plane) * sign;
  for (int i = 0; i < from.count; ++i) {
    const double* const b = from.corner[i];
    const double b_outside = (b[axis] - plane) * sign;
    if ((a_outside > 0.0) != (b_outside > 0.0)) {
      double* const r = to.corner[to.count++];
      const double f = (plane - a[axis]) / (b[axis] - a[axis]);
      for (int k = 0; k < 3; ++k)
        r[k] = std::clamp(a[k] + f * (b[k] - a[k]), std::min(a[k], b[k]), std::max(a[k], b[k]));
    }
    if (!(b_outside > 0.0)) std::copy(b, b + 3, to.corner[to.count++]);
    a = b;
    a_outside = b_outside;
  }
}

float round_down(double x) {
  const float f = round_to_float(x);
  return double{f} > x ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

float round_up(double x) { return -round_down(-x); }

}  // namespace

Box box_of(const Triangle& triangle) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    const float a = triangle.v0[axis], b = triangle.v1[axis], c = triangle.v2[axis];
    box.lo[axis] = std::min({a, b, c}) + 0.0f;
    box.hi[axis] = std::max({a, b, c}) + 0.0f;
  }
  return box;
}

bool clip_triangle(const Triangle& triangle, const Box& cell, Box& box) {
  const Box own = box_of(triangle);
  Polygon polygons[2];
  Polygon* now = &polygons[0];
  Polygon* next = &polygons[1];
  now->count = 3;
  double slack[3];
  for (int axis = 0; axis < 3; ++axis) {
    now->corner[0][axis] = double{triangle.v0[axis]};
    now->corner[1][axis] = double{triangle.v1[axis]};
    now->corner[2][axis] = double{triangle.v2[axis]};
    slack[axis] = kSlack * double{std::max(std::fabs(own.lo[axis]), std::fabs(own.hi[axis]))};
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (own.lo[axis] > cell.hi[axis] || own.hi[axis] < cell.lo[axis]) return false;
    for (const bool upper : {false, true}) {
      const float plane = upper ? cell.hi[axis] : cell.lo[axis];
      if (upper ? own.hi[axis] <= plane : own.lo[axis] >= plane) continue;
      const double sign = upper ? 1.0 : -1.0;
      clip(*now, axis, double{plane} + sign * slack[axis], sign, *next);
      if (next->count == 0) return false;
      std::swap(now, next);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    double lo = now->corner[0][axis];
    double hi = lo;
    for (int i = 1; i < now->count; ++i) {
      lo = std::min(lo, now->corner[i][axis]);
      hi = std::max(hi, now->corner[i][axis]);
    }
    box.lo[axis] = std::max({round_down(lo - slack[axis]), own.lo[axis], cell.lo[axis]}) + 0.0f;
    box.hi[axis] = std::min({round_up(hi + slack[axis]), own.hi[axis], cell.hi[axis]}) + 0.0f;
    if (box.lo[axis] > box.hi[axis]) return false;
  }
  return true;
}

}  // namespace plumb::detail
