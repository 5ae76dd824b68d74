#pragma once

#include <span>
#include <string>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/layers.h"

namespace plumb::detail {

/// The camera, whose members are open to all, must still see a pixel. Throws plumb::Error.
void check_camera(const Camera& camera);

/// The frame must be the camera's size and hold as many pixels. Throws plumb::Error.
void check_frame(const Frame& frame, const Camera& camera);

/// The same of a layered frame.
void check_frame(const LayeredFrame& frame, const Camera& camera);

/// There must be as many frames as cameras, each as check_frame() has it; `who` names the function that was
/// called. Throws plumb::Error, which names the frame by its index.
void check_frames(std::span<const Frame> frames, std::span<const Camera> cameras, const std::string& who);

}  // namespace plumb::detail
