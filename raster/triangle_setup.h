#pragma once

#include <cstdint>

#include "exact/intersect.h"
#include "raster/projection.h"

namespace plumb::detail {

/// value(x, y) = c + a x + b y over the frame, pixel centres at integers; `error` bounds how far it is from
/// the exact value for the pixel's float ray.
struct Plane {
  double a, b, c, error;
};

/// A triangle ready for the tiles: 2D-homogeneous edge functions (Olano and Greer 1997, "Triangle Scan
/// Conversion using 2D Homogeneous Coordinates"), turned and scaled.
struct TriangleSetup {
  /// The edge functions E0, E1, E2, turned so that all three are positive where the triangle is
  /// seen in front, each scaled so that |a| + |b| = 1: its unit is about a pixel.
  Plane edge[3];
  /// 1/t. Its error is `depth.error` + |1/t| * `depth_relative`.
  Plane depth;
  double depth_relative;
  std::int32_t x0, y0, x1, y1;  ///< pixels that may see it, both ends included
  std::uint32_t index;          ///< in the mesh
};

/// Sets up one triangle. Returns how many records it made: 0 where no pixel sees it, 1, or 2 where the
/// side that it turns to the eye is not certain (one for each side; then each pixel it may cover is decided
/// exactly, and deciding a pixel twice changes nothing). The triangle's coordinates may be anything.
int set_up_triangle(const Projection& view, const glm::vec3& eye, const Triangle& triangle,
                    std::uint32_t index, TriangleSetup records[2]);

}  // namespace plumb::detail
