#pragma once

#include <array>

// The Utah teapot: Martin Newell, "The Utilization of Procedure Models in Digital Image Synthesis",
// PhD thesis, University of Utah, 1975; the bottom is a later addition (Frank Crow, "The Origins of
// the Teapot", IEEE Computer Graphics and Applications 7(1), 1987). The published form is 32 bicubic
// Bezier patches over 306 control points. Those are the points below, told without their repetitions: body,
// lid and bottom are the same in all four quarters, handle and spout in both halves.
//
// z is up, the spout points to +x.

namespace plumb::detail {

/// A row of control points around the z axis. A quarter of it is (radius, 0), (radius, -pull),
/// (pull, -radius), (0, -radius), all at height z; the others follow by quarter turns.
struct TeapotRing {
  double radius, pull, z;
};

/// Rows from the rim's inside down to the foot; each patch begins with the last row of the one before.
inline constexpr std::array<TeapotRing, 10> kTeapotBody{{
    {1.4, 0.784, 2.4},
    {1.3375, 0.749, 2.53125},
    {1.4375, 0.805, 2.53125},
    {1.5, 0.84, 2.4},
    {1.75, 0.98, 1.875},
    {2.0, 1.12, 1.35},
    {2.0, 1.12, 0.9},
    {2.0, 1.12, 0.45},
    {1.5, 0.84, 0.225},
    {1.5, 0.84, 0.15},
}};

/// From the knob's top outward.
inline constexpr std::array<TeapotRing, 7> kTeapotLid{{
    {0.0, 0.0, 3.15},
    {0.8, 0.45, 3.15},
    {0.0, 0.0, 2.85},
    {0.2, 0.112, 2.7},
    {0.4, 0.224, 2.55},
    {1.3, 0.728, 2.55},
    {1.3, 0.728, 2.4},
}};

/// From the centre outward, to the foot. Seen from below, so the quarters run the other way round.
inline constexpr std::array<TeapotRing, 4> kTeapotBottom{{
    {0.0, 0.0, 0.0},
    {1.425, 0.798, 0.0},
    {1.5, 0.84, 0.075},
    {1.5, 0.84, 0.15},
}};

/// A row of control points around a tube that is symmetric about y = 0. One half is (x0, 0, z0),
/// (x0, -width, z0), (x1, -width, z1), (x1, 0, z1).
struct TeapotLoop {
  double x0, z0, x1, z1, width;
};

inline constexpr std::array<TeapotLoop, 7> kTeapotHandle{{
    {-1.6, 2.025, -1.5, 2.25, 0.3},
    {-2.3, 2.025, -2.5, 2.25, 0.3},
    {-2.7, 2.025, -3.0, 2.25, 0.3},
    {-2.7, 1.8, -3.0, 1.8, 0.3},
    {-2.7, 1.575, -3.0, 1.35, 0.3},
    {-2.5, 1.125, -2.65, 0.9375, 0.3},
    {-2.0, 0.9, -1.9, 0.6, 0.3},
}};

inline constexpr std::array<TeapotLoop, 7> kTeapotSpout{{
    {1.7, 1.425, 1.7, 0.6, 0.66},
    {2.6, 1.425, 3.1, 0.825, 0.66},
    {2.3, 2.1, 2.4, 2.025, 0.25},
    {2.7, 2.4, 3.3, 2.4, 0.25},
    {2.8, 2.475, 3.525, 2.49375, 0.25},
    {2.9, 2.475, 3.45, 2.5125, 0.15},
    {2.8, 2.4, 3.2, 2.4, 0.15},
}};

}  // namespace plumb::detail
