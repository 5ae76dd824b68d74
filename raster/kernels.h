#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "pixels/projection.h"
#include "pixels/screen_triangle.h"
#include "pixels/tile_state.h"
#include "plumb/frame.h"
#include "plumb/layers.h"
#include "plumb/raster.h"
#include "plumb/simd.h"
#include "raster/mesh_triangles.h"
#include "raster/square_lists.h"
#include "raster/tile_lists.h"

namespace plumb::detail {

/// Triangles that the frame may see: wide ones set up, the others listed with their tiles.
struct BinnedTriangles {
  TileLists lists;
  std::vector<ScreenTriangle> wide;
};

/// What a tile may see, in the order in which it is drawn.
struct TileContents {
  std::vector<SortedList> sorted;
  std::vector<WideEntry> wide;  ///< roughly from front to back
  std::vector<EntryRun> runs;   ///< from front to back

  bool empty() const { return sorted.empty() && wide.empty() && runs.empty(); }
};

/// A tile on the way to the frame.
struct TileJob {
  const Projection& projection;
  const TileView& view;
  const TileContents& contents;
  bool fresh;  ///< what the frame holds does not count
};

/// The steps of rasterizing that are compiled per SIMD target. Callers hold the default floating-point
/// mode.
struct RasterKernels {
  /// Adds the mesh's triangles from `first` to before `last`, but those that no pixel sees.
  void (*bin)(const Projection& view, MeshView mesh, std::size_t first, std::size_t last,
              BinnedTriangles& to);
  /// Draws a tile and merges it into the frame; where it may see nothing, clears it.
  void (*draw_tile)(const TileJob& job, const MeshTriangles& mesh, Frame& frame);
  /// Adds what the tile's pixels meet to the frame's entries.
  void (*draw_layers)(const TileJob& job, const MeshTriangles& mesh, LayeredFrame& frame);
  /// As draw_tile, and counts what it tests.
  void (*count_tile)(const TileJob& job, const MeshTriangles& mesh, Frame& frame, RasterCounts& counts);
};

/// Those of one resolved target.
RasterKernels raster_kernels(Simd simd);

}  // namespace plumb::detail
