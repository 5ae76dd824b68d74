#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pixels/tile_state.h"
#include "plumb/frame.h"
#include "plumb/simd.h"
#include "raster/projection.h"

namespace plumb::detail {

/// A triangle in a tile's list.
struct BinEntry {
  std::uint32_t triangle;  ///< index into the batch's records
  float nearest;           ///< ScreenTriangle::nearest
};

/// The steps of rasterizing that are compiled per SIMD target. Callers hold the default floating-point
/// mode.
struct RasterKernels {
  /// Sets up the mesh's triangles from `first` to before `last`; returns how many may be seen and fills
  /// as many of `to`, which has room for all.
  std::size_t (*set_up)(const Projection& view, MeshView mesh, std::size_t first, std::size_t last,
                        ScreenTriangle* to);
  /// Begins a tile with what the frame holds.
  void (*load_tile)(const TileTask& task, const Frame& frame, TileState& state);
  /// Draws the entries into the tile.
  void (*draw_tile)(const TileTask& task, std::span<const BinEntry> entries, TileState& state);
  /// Gives the frame what the tile has seen.
  void (*store_tile)(const TileTask& task, TileState& state, Frame& frame);
};

/// Those of one resolved target.
RasterKernels raster_kernels(Simd simd);

}  // namespace plumb::detail
