#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace plumb {

/// What a camera sees: a depth and a triangle id for each pixel, row-major from the top. A pixel
/// that sees nothing holds +inf and kNone.
struct Frame {
  /// A clear frame. Throws plumb::Error when a size is below 1.
  Frame(int width, int height);

  /// Every pixel to {+inf, kNone}.
  void clear();

  int width;                      ///< pixels, at least 1
  int height;                     ///< pixels, at least 1
  std::vector<float> depth;       ///< t of pixel (x, y) at y * width + x; t as in Hit, +inf for nothing
  std::vector<std::uint32_t> id;  ///< id of pixel (x, y) at y * width + x; kNone for nothing
};

/// A pixel in which two frames differ, and what each saw there.
struct PixelDifference {
  int x;               ///< from the left, from 0
  int y;               ///< from the top, from 0
  float depth_a;       ///< in the first frame
  float depth_b;       ///< in the second frame
  std::uint32_t id_a;  ///< in the first frame
  std::uint32_t id_b;  ///< in the second frame
};

/// Where and how much two frames differ. Depths are compared as bits.
struct Comparison {
  std::size_t pixels = 0;              ///< compared
  std::size_t different_ids = 0;       ///< pixels whose ids differ
  std::size_t different_depths = 0;    ///< pixels whose depths differ
  std::size_t different_pixels = 0;    ///< pixels in which either differs
  std::vector<PixelDifference> first;  ///< the first of them in row order, at most kMaxListed

  /// How many places are listed at most.
  static constexpr std::size_t kMaxListed = 16;
  /// Whether the frames are equal to the bit.
  bool equal() const { return different_pixels == 0; }
};

/// Compares two frames of one size bit by bit. Throws plumb::Error when the sizes differ or a frame
/// does not hold a depth and an id for each pixel.
Comparison compare(const Frame& a, const Frame& b);

}  // namespace plumb
