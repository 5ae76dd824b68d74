#pragma once

#include <cstdint>

// How a frame is cut: tiles of 32 x 32 pixels, each of 8 x 8 blocks of 4 x 4 pixels. A block's pixels lie
// together, row by row, and a tile's blocks too, so that 16 neighbours fill a vector.

namespace plumb::detail {

inline constexpr int kBlockPx = 4;
inline constexpr int kBlockPixels = kBlockPx * kBlockPx;
inline constexpr int kTileBlocks = 8;  ///< along each side
inline constexpr int kTilePx = kTileBlocks * kBlockPx;
inline constexpr int kTilePixels = kTilePx * kTilePx;

/// Where the pixel (x, y) of a tile lies among its pixels; x and y from 0 to 31.
inline constexpr int tile_offset(int x, int y) {
  const int block = (y / kBlockPx) * kTileBlocks + x / kBlockPx;
  return block * kBlockPixels + (y % kBlockPx) * kBlockPx + x % kBlockPx;
}

/// The coordinates of the pixel at an offset.
inline constexpr int tile_x(int offset) {
  return (offset / kBlockPixels % kTileBlocks) * kBlockPx + offset % kBlockPx;
}
inline constexpr int tile_y(int offset) {
  return (offset / (kBlockPixels * kTileBlocks)) * kBlockPx + offset % kBlockPixels / kBlockPx;
}

}  // namespace plumb::detail
