#pragma once

#include <cstdint>
#include <span>

#include "cases/cases.h"

namespace plumb::fuzz {

/// A small scene, rays and maybe a camera, for any bytes: at most 12 vertices, 16 triangles, 6 rays and a
/// frame of 8 x 6 pixels. Coordinates are any floats, numbers on a lattice, or earlier coordinates and their
/// neighbours, so that a change of one byte makes ties and takes them away.
cases::Instance instance_of(std::span<const std::uint8_t> bytes);

}  // namespace plumb::fuzz
