#pragma once

#include "build/triangle_refs.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// Which sides of a plane have a part of a triangle.
struct Sides {
  bool left, right;
};

/// Cuts a reference at the plane where the axis' coordinate is `plane`, between its box's. What of the
/// triangle is in the reference's box and at or below the plane is in `left`'s box, what is at or above it in
/// `right`'s; both boxes are within the reference's. A side that has no part for certain is told by the
/// result, and its box means nothing.
///
/// The triangle must be finite. The caller holds the default floating-point mode.
Sides split_reference(MeshView mesh, const TriangleRef& ref, int axis, float plane, TriangleRef& left,
                      TriangleRef& right);

/// The same for an estimate: in float, with its roundings, and NaN where they overflow.
void estimate_split(MeshView mesh, const TriangleRef& ref, int axis, float plane, Box4& left, Box4& right);

}  // namespace plumb::detail
