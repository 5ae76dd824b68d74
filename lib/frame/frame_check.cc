#include "frame/frame_check.h"

#include <string>

#include "plumb/error.h"

namespace plumb::detail {

void check_camera(const Camera& camera) {
  if (camera.width >= 1 && camera.height >= 1) return;
  throw Error("plumb: the camera sees " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
              " pixels; both sizes must be at least 1");
}

void check_frame(const Frame& frame, const Camera& camera) {
  check_camera(camera);
  if (frame.width != camera.width || frame.height != camera.height) {
    throw Error("plumb: the frame is " + std::to_string(frame.width) + "x" + std::to_string(frame.height) +
                " but the camera sees " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                " pixels; give them one size");
  }
  const std::size_t pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  if (frame.depth.size() != pixels || frame.id.size() != pixels) {
    throw Error("plumb: the frame's depth and id hold " + std::to_string(frame.depth.size()) + " and " +
                std::to_string(frame.id.size()) + " pixels instead of " + std::to_string(pixels));
  }
}

void check_frames(std::span<const Frame> frames, std::span<const Camera> cameras, const std::string& who) {
  if (cameras.size() != frames.size()) {
    throw Error("plumb: " + who + "() was given " + std::to_string(cameras.size()) + " cameras but " +
                std::to_string(frames.size()) + " frames; give it one for each");
  }
  for (std::size_t i = 0; i < frames.size(); ++i) {
    try {
      check_frame(frames[i], cameras[i]);
    } catch (const Error& error) {
      throw Error("plumb: " + who + "(): frame " + std::to_string(i) + ": " + error.what());
    }
  }
}

}  // namespace plumb::detail
