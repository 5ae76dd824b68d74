#include "plumb/frame.h"

#include <algorithm>
#include <limits>
#include <string>

#include "plumb/error.h"
#include "plumb/ray.h"

namespace plumb {
namespace {

std::size_t pixel_count(int width, int height) {
  if (width < 1 || height < 1) {
    throw Error("plumb: frame of " + std::to_string(width) + " x " + std::to_string(height) +
                " pixels; width and height must be at least 1");
  }
  return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

}  // namespace

Frame::Frame(int width_in, int height_in)
    : width(width_in),
      height(height_in),
      depth(pixel_count(width, height), std::numeric_limits<float>::infinity()),
      id(depth.size(), kNone) {}

void Frame::clear() {
  std::fill(depth.begin(), depth.end(), std::numeric_limits<float>::infinity());
  std::fill(id.begin(), id.end(), kNone);
}

}  // namespace plumb
