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
  /// Its least value z in a box bounds the t of what is seen there: t >= depth_scale z, where z > 0.
  BoxPlane depth;
  float depth_scale;
};

/// Between which t the rays of a tile are between two planes across an axis. Where all their directions have
/// one sign there, s, and sizes from d0 to d1, a ray that is in a box at t > 0 has
///     s (near - eye) / d1 <= t <= s (far - eye) / d0
/// for the planes near and far that they meet first and last. Each is the difference, rounded once, times a
/// scale that is 2^-21 (8 u) off to the safe side; where that underflows it is off by less than kSlabRoom.
struct TileSlab {
  float eye;
  float near_scale;  ///< s / d1 and below, or 0
  float far_scale;   ///< s / d0 and above, or 0
  float far_room;    ///< kSlabRoom, or infinity where nothing bounds t from above
  std::uint32_t near_row, far_row;
};

inline constexpr float kSlabRoom = 0x1p-120f;

/// A box is not met where `near` of it is this much above `far`, or hidden where near times a bound of 1/t is
/// this much above 1: 2 u for the product, the rest as in pixels/screen_bounds-inl.h.
inline constexpr float kTileRoom = 1.0f + 0x1p-20f;

/// What a rectangle of pixels may see.
struct TileFrustum {
  /// Both ends of the rectangle included.
  TileFrustum(const FrameFrustum& frame, int x0, int y0, int x1, int y1);

  /// A box that is below 0 all over in one of these is not seen.
  BoxPlane side[4];
  TileSlab slab[3];
};

}  // namespace plumb::detail
