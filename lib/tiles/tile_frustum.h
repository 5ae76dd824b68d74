#pragma once

#include <cstdint>

#include "pixels/projection.h"

// What a tile's pixels may see, as planes through the eye that the boxes of a wide tree are tested against in
// float. A box is culled only where no ray of the tile meets it: a hit's exact point lies in the closed box
// of its triangle, whatever the displacement of docs/visibility.md (trace/box_ray.h).

namespace plumb::detail {

/// n.q + offset, for a point q of the scene in its own coordinates. The corner of a box where that is
/// greatest, or least, is picked by the rows of WideNode::bounds.
///
/// n = N / |N|_1 rounded to float and o = -n.eye + room likewise. With u = 2^-24, G the greatest
/// |coordinate| of the scene, e that of the eye and R = G + e, what is computed in three steps, fused or not,
/// is off from N.(q - eye) / |N|_1 + room by
///     n: u G     the products: u G     the three sums, none above R but for `room`: 3 u R     o: u (e +
///     room)
/// so by less than 6.1 u R; 8 u R is taken for room, and N's own error on top.
struct BoxPlane {
  float normal[3];
  float offset;
  std::uint32_t greatest_row[3], least_row[3];
};

/// What all tiles of a frame share.
struct FrameFrustum {
  /// `greatest` is the greatest |coordinate| of the scene's finite triangles.
  FrameFrustum(const Projection& view, float greatest);

  const Projection& view;
  double reach;  ///< R
  /// The bounds hold: the screen bounds what is seen where, and nothing overflows.
  bool usable;
  /// Its least value z > 0 in a box bounds the 1/t of what is seen there: 1/t <= depth_scale / z, with room
  /// for the rounding of t and of z times a bound of 1/t.
  BoxPlane depth;
  float depth_scale;
};

/// The side planes of a rectangle of pixels: a box that is below 0 all over in one of them is not seen in it.
struct TileFrustum {
  /// Both ends of the rectangle included.
  TileFrustum(const FrameFrustum& frame, int x0, int y0, int x1, int y1);

  BoxPlane side[4];
};

}  // namespace plumb::detail
