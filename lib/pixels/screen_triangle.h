#pragma once

#include <cstdint>

namespace plumb::detail {

/// A triangle as tiles draw it: 2D-homogeneous edge functions (Olano and Greer 1997, "Triangle Scan
/// Conversion using 2D Homogeneous Coordinates") and 1/t, each a plane over the frame:
///
///     value(x, y) = c + a x + b y, pixel centres at integers,
///
/// in double, and within `error` of the exact value for the pixel's float ray at every pixel of the frame.
///
/// Planes 0 to 2 are the edge functions E0, E1, E2, turned so that all three are positive where the
/// triangle is seen in front, and scaled so that |a| + |b| = 1: their unit is about a pixel. Plane 3 is
/// 1/t; its error is up to kDepthRelative |1/t| more.
struct alignas(16) ScreenTriangle {
  double a[4], b[4], c[4];
  double plane[6];  ///< DrawnTriangles' normal and bounds (pixels/tile_state.h)
  float error[4];
  std::int32_t x0, y0, x1, y1;  ///< Pixels that may see it, both ends included.
  std::uint32_t index;          ///< In the mesh.
  float nearest;                ///< No pixel sees it at 1/t above this; with room for the rounding of t.
  /// The eye lies in its plane or so near that the side it sees is open: it is to be drawn as it is and
  /// with all edges turned, and every pixel it may cover is to be decided exactly.
  bool side_open;

  static constexpr double kDepthRelative = 0x1p-26;
};

/// The same about one tile, in float: pixel centres count from the tile's centre, and `error` is everything
/// between a value computed at a pixel and the exact one for its ray.
struct alignas(16) TileTriangle {
  float a[4], b[4], c[4], error[4];
  float edge_error;  ///< the greatest of the edge functions'
  float nearest;
  std::uint32_t place;          ///< in TileState::drawn
  std::uint8_t x0, y0, x1, y1;  ///< in the tile
};

}  // namespace plumb::detail
