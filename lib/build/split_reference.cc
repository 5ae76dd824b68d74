#include "build/split_reference.h"

#include <algorithm>
#include <cmath>

#include "base/round.h"

// The part of a triangle at one side of a plane is the hull of its corners there and of the points where its
// edges cross the plane. Corners are taken as they are. A crossing of the edge from a to b is, exactly,
//
//     r = a + f (b - a),  f = (p - a) / (b - a) along the plane's axis,  0 <= f <= 1
//
// In double, with u = 2^-53 and M the greater of |a| and |b| along an axis, f has three roundings and r three
// more: with |b - a| <= 2 M its error is at most 2 M (3.01 + 2.01) u + 1.01 u M < 12 u M. Underflow is out
// of reach: differences of doubles that come from floats this way are 0 or at least 2^-149, f is at least
// 2^-279. Rounding r - w to float moves it by at most 2^-24 (M + w) + 2^-150. So with
//
//     w = 2^-23 M + 2^-149
//
// the float is at most the exact r, for 12 u M + 2^-24 (M + w) + 2^-150 < w; and the other way at least. A
// float beyond a and b is replaced by them, for the exact r lies between. Along the plane's axis r is the
// plane.
//
// The whole triangle is cut, so that what was lost to rounding before is not lost again: if every point of
// the triangle within some region is in the reference's box, then so is every one within the region and at a
// side of the plane in that side's, the meet of the reference's box and of the hull's. By induction the boxes
// of all references to a triangle, which begin with its own box, cover it: a point of it is at one side at
// least of each plane that its reference is cut at.

namespace plumb::detail {
namespace {

Float4 corner_of(MeshView mesh, const glm::uvec3& corners, int v) {
  const glm::vec3& p = mesh.positions[corners[v]];
  return Float4{p.x, p.y, p.z, 0.0f};
}

struct Crossing {
  Float4 lo, hi;
};

Crossing cross(const Float4& a, const Float4& b, int axis, float plane) {
  const double f = (double{plane} - double{a[axis]}) / (double{b[axis]} - double{a[axis]});
  Crossing r{a, a};
  for (int k = 0; k < 3; ++k) {
    const double x = double{a[k]} + f * (double{b[k]} - double{a[k]});
    const double w = 0x1p-23 * double{std::max(std::fabs(a[k]), std::fabs(b[k]))} + 0x1p-149;
    r.lo[k] = std::max(round_to_float(x - w), std::min(a[k], b[k]));
    r.hi[k] = std::min(round_to_float(x + w), std::max(a[k], b[k]));
  }
  r.lo[axis] = r.hi[axis] = plane;
  return r;
}

bool any_inside(const TriangleRef& ref) {
  return ref.lo[0] <= ref.hi[0] && ref.lo[1] <= ref.hi[1] && ref.lo[2] <= ref.hi[2];
}

// The meet of the reference's box and the hull's, with zeros positive.
TriangleRef meet(const TriangleRef& ref, const Box4& hull) {
  const Float4 no_negative_zero = splat(0.0f);
  TriangleRef result;
  result.lo = max(hull.lo, ref.lo) + no_negative_zero;
  result.hi = min(hull.hi, ref.hi) + no_negative_zero;
  result.set_index(ref.index());
  return result;
}

}  // namespace

Sides split_reference(MeshView mesh, const TriangleRef& ref, int axis, float plane, TriangleRef& left,
                      TriangleRef& right) {
  const glm::uvec3& corners = mesh.triangles[ref.index()];
  Box4 below, above;
  Float4 a = corner_of(mesh, corners, 2);
  for (int v = 0; v < 3; ++v) {
    const Float4 b = corner_of(mesh, corners, v);
    if ((a[axis] < plane && b[axis] > plane) || (a[axis] > plane && b[axis] < plane)) {
      const Crossing r = cross(a, b, axis, plane);
      below.add(r.lo, r.hi);
      above.add(r.lo, r.hi);
    }
    if (b[axis] <= plane) below.add(b, b);
    if (b[axis] >= plane) above.add(b, b);
    a = b;
  }
  left = meet(ref, below);
  right = meet(ref, above);
  return {any_inside(left), any_inside(right)};
}

void estimate_split(MeshView mesh, const TriangleRef& ref, int axis, float plane, Box4& left, Box4& right) {
  const glm::uvec3& corners = mesh.triangles[ref.index()];
  Box4 below, above;
  Float4 a = corner_of(mesh, corners, 2);
  for (int v = 0; v < 3; ++v) {
    const Float4 b = corner_of(mesh, corners, v);
    if ((a[axis] < plane) != (b[axis] < plane)) {
      const Float4 r = a + (b - a) * splat((plane - a[axis]) / (b[axis] - a[axis]));
      below.add(r, r);
      above.add(r, r);
    }
    if (b[axis] <= plane) below.add(b, b);
    if (b[axis] >= plane) above.add(b, b);
    a = b;
  }
  left.lo = max(below.lo, ref.lo);
  left.hi = min(below.hi, ref.hi);
  right.lo = max(above.lo, ref.lo);
  right.hi = min(above.hi, ref.hi);
}

}  // namespace plumb::detail
