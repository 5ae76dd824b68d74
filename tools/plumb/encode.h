#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "plumb/frame.h"

namespace plumb::tool {

/// A picture: red, green, blue of each pixel, row-major from the top.
struct Image {
  int width, height;
  std::vector<std::uint8_t> rgb;
};

/// The frame as an OpenEXR file, bit for bit: channel `Z` (float) is the depth, `id` (uint) the
/// triangle; zip compression, which loses nothing. Nothing seen is +inf and 4294967295.
std::vector<std::byte> encode_exr(const Frame& frame);

/// The picture as a PNG file.
std::vector<std::byte> encode_png(const Image& image);

}  // namespace plumb::tool
