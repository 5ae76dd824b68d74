#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plumb/frame.h"

namespace plumb {

/// A triangle that pixels see.
struct VisibleTriangle {
  std::uint32_t id;      ///< as in Hit
  std::uint64_t pixels;  ///< how many see it, at least 1

  /// Equal in both.
  friend bool operator==(const VisibleTriangle&, const VisibleTriangle&) = default;
};

/// The triangles that a frame's pixels see, by rising id. Takes time proportional to the pixels, and while it
/// runs up to 8 bytes for each of them.
std::vector<VisibleTriangle> visible_triangles(const Frame& frame);

/// Those that the pixels of any of the frames see, the pixels of all added up: a potentially visible set,
/// from as many places as there are frames.
std::vector<VisibleTriangle> visible_triangles(std::span<const Frame> frames);

}  // namespace plumb
