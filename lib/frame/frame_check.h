#pragma once

#include "plumb/camera.h"
#include "plumb/frame.h"

namespace plumb::detail {

/// The frame must be the camera's size and hold as many pixels. Throws plumb::Error.
void check_frame(const Frame& frame, const Camera& camera);

}  // namespace plumb::detail
