#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "plumb/raster.h"

namespace plumb::detail {

/// What a tile's triangles are tested against, counted.
struct TileCounts {
  RasterCounts& to;

  void tile(bool hidden) {
    ++to.tiles;
    to.tiles_hidden += hidden ? 1 : 0;
  }
  void block_tests(std::size_t n) { to.block_tests += n; }
  void block(bool full) {
    ++to.blocks;
    to.blocks_full += full ? 1 : 0;
  }
  void won_blocks(std::uint32_t bits) {
    to.blocks += static_cast<std::uint64_t>(std::popcount(bits));
    to.blocks_full += static_cast<std::uint64_t>(std::popcount(bits));
  }
  void open_pixels(std::uint32_t bits) {
    to.pixels_decided += static_cast<std::uint64_t>(std::popcount(bits));
  }
};

}  // namespace plumb::detail
