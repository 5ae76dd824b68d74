#pragma once

#include <cstddef>
#include <cstdint>

namespace plumb::detail {

/// What a tile's triangles are tested against, uncounted; raster/tile_counts.h counts it.
struct NoTileCounts {
  void tile(bool) {}
  void block_tests(std::size_t) {}
  void block(bool) {}
  void won_blocks(std::uint32_t) {}
  void open_pixels(std::uint32_t) {}
};

}  // namespace plumb::detail
