#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "pixels/projection.h"
#include "pixels/screen_triangle.h"
#include "pixels/tile_state.h"
#include "plumb/frame.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "raster/mesh_triangles.h"

namespace plumb::detail {

/// Triangles set up: those of one tile each about their tile, the others over the frame.
struct BinnedTriangles {
  TileTriangle* placed;
  ScreenTriangle* wide;
};

/// A triangle in a tile's list.
class BinEntry {
 public:
  BinEntry() = default;
  BinEntry(bool placed, std::uint32_t index, float nearest_in)
      : nearest(nearest_in), word_(index | (placed ? kPlaced : 0)) {}

  bool placed() const { return (word_ & kPlaced) != 0; }
  std::uint32_t index() const { return word_ & ~kPlaced; }

  float nearest;  ///< ScreenTriangle::nearest

 private:
  static constexpr std::uint32_t kPlaced = 0x80000000u;
  std::uint32_t word_;
};

/// How many triangles were set up.
struct SetupCounts {
  std::size_t placed, wide;
};

/// The steps of rasterizing that are compiled per SIMD target. Callers hold the default floating-point
/// mode.
struct RasterKernels {
  /// Sets up the mesh's triangles from `first` to before `last`. `to` has room for all of them of either
  /// kind; those that no pixel sees are left out.
  SetupCounts (*set_up)(const Projection& view, MeshView mesh, std::size_t first, std::size_t last,
                        const BinnedTriangles& to);
  /// Draws the entries into a tile and merges it into the frame.
  void (*draw_tile)(const TileView& view, const MeshTriangles& mesh, const BinnedTriangles& triangles,
                    std::span<const BinEntry> entries, Frame& frame);
  /// The same, and counts what it tests.
  void (*count_tile)(const TileView& view, const MeshTriangles& mesh, const BinnedTriangles& triangles,
                     std::span<const BinEntry> entries, Frame& frame, RasterCounts& counts);
};

/// Those of one resolved target.
RasterKernels raster_kernels(Simd simd);

}  // namespace plumb::detail
