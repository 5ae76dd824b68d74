#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pixels/projection.h"
#include "pixels/screen_triangle.h"
#include "plumb/mesh.h"
#include "raster/kernels.h"
#include "raster/square_lists.h"
#include "raster/tile_lists.h"

namespace plumb::detail {

/// Which triangles each tile may see: filled batch by batch, its memory kept.
///
/// A triangle within two tiles by two is listed with each of them, by its index: a tile sets up what is not
/// hidden by then. A wide one is set up here, once, and listed with the squares of one of several grids that
/// it may touch: tiles, or squares 8 or 64 times as wide, the finest where they are few. That bounds the
/// lists' memory; a tile's wide triangles are those of all squares that it lies in.
class Bins {
 public:
  Bins(const Projection& projection, const RasterKernels& kernels);

  /// Lists the mesh's triangles from `first` on, on up to `threads` threads: to before `last`, or as many as
  /// the lists shall hold. Returns where it ended. What tiles see of these does not depend on the threads.
  std::size_t fill(MeshView mesh, std::size_t first, std::size_t last, int threads);

  const SquareGrid& tiles() const { return grids_[0]; }
  /// Appends what the tile may see to `to`, empty but for memory.
  void collect(std::size_t tile, TileContents& to) const;

 private:
  static constexpr int kGrids = 3;
  // What one thread lists.
  struct Slot {
    BinnedTriangles triangles;
    std::array<SquareLists, kGrids> wide;
  };

  void add_wide(const ScreenTriangle& triangle, Slot& slot) const;

  const Projection& projection_;
  const RasterKernels& kernels_;
  std::array<SquareGrid, kGrids> grids_;
  std::vector<Slot> slots_;
};

}  // namespace plumb::detail
