#include <png.h>

#include <fmt/format.h>

#include "encode.h"
#include "plumb/error.h"

namespace plumb::tool {

std::vector<std::byte> encode_png(const Image& image) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<std::byte> bytes(size);
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.rgb.data(), 0, nullptr) == 0) {
    throw Error(fmt::format("plumb: libpng could not encode a picture of {}x{} pixels: {}", image.width,
                            image.height, png.message));
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace plumb::tool
