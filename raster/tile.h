#pragma once

#include <cstdint>
#include <span>

#include "pixels/tile.h"
#include "plumb/camera.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "raster/triangle_setup.h"

namespace plumb::detail {

/// What a tile's pixels have seen so far: the answer for everything drawn.
struct TilePixels {
  float t[kTilePixels];
  std::uint32_t id[kTilePixels];
};

/// What drawing into a tile needs beside the records.
struct TileTask {
  const Camera& camera;
  bool exact_only;  ///< directions may be zero or not finite: ask before each exact decision
  MeshView mesh;
  std::uint32_t first_id;
  int x, y;  ///< of the tile's upper left pixel
};

/// Draws the records named in `list` into the tile. Callers hold the default floating-point mode.
using DrawTile = void (*)(const TileTask& task, std::span<const TriangleSetup> records,
                          std::span<const std::uint32_t> list, TilePixels& pixels);

/// The kernel for one resolved target.
DrawTile draw_tile_kernel(Simd simd);

}  // namespace plumb::detail
