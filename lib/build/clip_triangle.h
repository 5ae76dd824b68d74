#pragma once

#include "build/binary_tree.h"
#include "exact/intersect.h"

namespace plumb::detail {

/// The smallest box of a triangle. Zeros in it are positive.
Box box_of(const Triangle& triangle);

/// Finds a box that holds every point of the closed triangle in the closed cell, itself within the cell and
/// the triangle's own box and, beyond these, little larger than it must be. False when there is no such point
/// for certain. The triangle must be finite. The caller holds the default floating-point mode.
bool clip_triangle(const Triangle& triangle, const Box& cell, Box& box);

}  // namespace plumb::detail
