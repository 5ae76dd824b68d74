#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>

#include "frame/frame_check.h"
#include "plumb/error.h"
#include "plumb/layers.h"
#include "plumb/ray.h"

namespace plumb {
namespace {

std::size_t entry_count(int width, int height, int layers) {
  if (width < 1 || height < 1 || layers < 1 || layers > LayeredFrame::kMostLayers) {
    throw Error("plumb: layered frame of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels and " + std::to_string(layers) +
                " layers; width and height must be at least 1, layers from 1 to " +
                std::to_string(LayeredFrame::kMostLayers));
  }
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
         static_cast<std::size_t>(layers);
}

}  // namespace

LayeredFrame::LayeredFrame(int width_in, int height_in, int layers_in)
    : width(width_in),
      height(height_in),
      layers(layers_in),
      depth(entry_count(width, height, layers), std::numeric_limits<float>::infinity()),
      id(depth.size(), kNone) {}

void LayeredFrame::clear() {
  std::fill(depth.begin(), depth.end(), std::numeric_limits<float>::infinity());
  std::fill(id.begin(), id.end(), kNone);
}

Frame LayeredFrame::layer(int index) const {
  if (index < 0 || index >= layers) {
    throw Error("plumb: the frame has layers 0 to " + std::to_string(layers - 1) + ", not " +
                std::to_string(index));
  }
  Frame frame(width, height);
  for (std::size_t pixel = 0; pixel < frame.id.size(); ++pixel) {
    const std::size_t entry = pixel * static_cast<std::size_t>(layers) + static_cast<std::size_t>(index);
    frame.depth[pixel] = depth[entry];
    frame.id[pixel] = id[entry];
  }
  return frame;
}

namespace detail {

void check_frame(const LayeredFrame& frame, const Camera& camera) {
  check_camera(camera);
  if (frame.width != camera.width || frame.height != camera.height) {
    throw Error("plumb: the layered frame is " + std::to_string(frame.width) + "x" +
                std::to_string(frame.height) + " but the camera sees " + std::to_string(camera.width) + "x" +
                std::to_string(camera.height) + " pixels; give them one size");
  }
  const std::size_t entries = entry_count(frame.width, frame.height, frame.layers);
  if (frame.depth.size() != entries || frame.id.size() != entries) {
    throw Error("plumb: the layered frame's depth and id hold " + std::to_string(frame.depth.size()) +
                " and " + std::to_string(frame.id.size()) + " entries instead of " + std::to_string(entries));
  }
}

}  // namespace detail
}  // namespace plumb
