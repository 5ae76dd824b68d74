#pragma once

#include "encode.h"
#include "plumb/frame.h"

namespace plumb::tool {

/// Depth as colour, near bright and far dark, over the range that the frame's pixels span, shaded as
/// a relief lit from the upper left. Where nothing is seen the picture is pale grey.
Image depth_picture(const Frame& frame);

/// A colour for each triangle, told by its id alone: the same in every frame. Where nothing is seen
/// the picture is pale grey.
Image id_picture(const Frame& frame);

/// The first frame's relief in grey, and over it, red where the ids differ, and orange where only the
/// depths do, with a ring around each such pixel that makes a single one easy to find.
Image difference_picture(const Frame& a, const Frame& b);

}  // namespace plumb::tool
