#include <bit>
#include <cstdint>
#include <string>

#include "plumb/error.h"
#include "plumb/frame.h"

namespace plumb {
namespace {

std::string size_text(const Frame& frame) {
  return std::to_string(frame.width) + " x " + std::to_string(frame.height);
}

// The members are public, so a frame may have been resized by hand.
void require_whole(const Frame& frame, const char* name) {
  const bool whole =
      frame.width >= 1 && frame.height >= 1 &&
      frame.depth.size() == static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height) &&
      frame.id.size() == frame.depth.size();
  if (whole) return;
  throw Error("plumb: " + std::string(name) + " frame is " + size_text(frame) + " but holds " +
              std::to_string(frame.depth.size()) + " depths and " + std::to_string(frame.id.size()) +
              " ids; it must hold one of each per pixel");
}

}  // namespace

Comparison compare(const Frame& a, const Frame& b) {
  require_whole(a, "the first");
  require_whole(b, "the second");
  if (a.width != b.width || a.height != b.height) {
    throw Error("plumb: cannot compare a frame of " + size_text(a) + " with one of " + size_text(b) +
                "; make both of one size");
  }
  Comparison result;
  result.pixels = a.depth.size();
  for (std::size_t i = 0; i < result.pixels; ++i) {
    const bool id_differs = a.id[i] != b.id[i];
    const bool depth_differs =
        std::bit_cast<std::uint32_t>(a.depth[i]) != std::bit_cast<std::uint32_t>(b.depth[i]);
    if (!id_differs && !depth_differs) continue;
    result.different_ids += id_differs ? 1 : 0;
    result.different_depths += depth_differs ? 1 : 0;
    ++result.different_pixels;
    if (result.first.size() < Comparison::kMaxListed) {
      const std::size_t width = static_cast<std::size_t>(a.width);
      result.first.push_back({static_cast<int>(i % width), static_cast<int>(i / width), a.depth[i],
                              b.depth[i], a.id[i], b.id[i]});
    }
  }
  return result;
}

}  // namespace plumb
