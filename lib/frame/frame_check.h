#pragma once

#include "plumb/camera.h"
#include "plumb/frame.h"

namespace plumb::detail {

/// The camera, whose members are open to all, must still see a pixel. Throws plumb::Error.
void check_camera(const Camera& camera);

/// The frame must be the camera's size and hold as many pixels. Throws plumb::Error.
void check_frame(const Frame& frame, const Camera& camera);

}  // namespace plumb::detail
