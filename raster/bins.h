#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pixels/projection.h"
#include "pixels/screen_triangle.h"
#include "plumb/mesh.h"
#include "raster/kernels.h"

namespace plumb::detail {

/// A frame cut into squares, row by row.
struct SquareGrid {
  int side_px, columns, rows;

  SquareGrid(int width, int height, int side_px);
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// Lists of triangles, one for each square that has some.
class SquareLists {
 public:
  void clear();
  void add(std::uint32_t square, BinEntry entry);
  /// Orders what was added by square; within one, in the order of adding.
  void sort();

  /// The squares with a list that is not empty lie from begin() to before end().
  std::uint32_t begin() const { return begin_; }
  std::uint32_t end() const { return end_; }
  std::span<const BinEntry> list(std::uint32_t square) const;

 private:
  std::vector<std::uint32_t> added_to_;
  std::vector<BinEntry> added_;
  std::uint32_t begin_ = 0, end_ = 0;
  std::vector<std::uint32_t> start_;
  std::vector<BinEntry> entries_;
};

/// Triangles set up, and which tiles each may touch: filled batch by batch, its memory kept.
///
/// A triangle in one tile is listed with it. A wide one is listed with the squares of one of several grids
/// that it may touch: tiles, or squares 8 or 64 times as wide, the finest where they are few. That bounds the
/// lists' memory; a tile's triangles are those of all squares that it lies in.
class Bins {
 public:
  /// Triangles of a batch.
  static constexpr std::size_t kBatch = std::size_t{1} << 18;

  Bins(const Projection& projection, const RasterKernels& kernels);

  /// Sets up and sorts the mesh's triangles from `first` to before `last`, at most kBatch, on up to
  /// `threads` threads. The result does not depend on how many.
  void fill(MeshView mesh, std::size_t first, std::size_t last, int threads);

  BinnedTriangles triangles() const { return {placed_.get(), wide_.get()}; }
  const SquareGrid& tiles() const { return grids_[0]; }
  /// The tiles that may be touched lie from this to before end_tile().
  std::size_t begin_tile() const { return begin_tile_; }
  std::size_t end_tile() const { return end_tile_; }
  /// The triangles that may touch the tile: wide ones, roughly from front to back, then the others.
  std::vector<BinEntry> list(std::size_t tile) const;

 private:
  static constexpr int kGrids = 3;
  // Of the part of a batch that one thread sets up.
  struct Lists {
    std::array<SquareLists, kGrids> wide;
    SquareLists placed;
  };

  void fill_chunk(MeshView mesh, std::size_t first, std::size_t last, std::size_t chunk);
  void add_wide(std::uint32_t index, Lists& lists) const;
  void cover_tiles(const SquareGrid& grid, const SquareLists& lists);

  const Projection& projection_;
  const RasterKernels& kernels_;
  std::array<SquareGrid, kGrids> grids_;
  std::unique_ptr<TileTriangle[]> placed_;
  std::unique_ptr<ScreenTriangle[]> wide_;
  std::size_t capacity_ = 0;
  std::size_t begin_tile_ = 0, end_tile_ = 0;
  std::vector<Lists> chunks_;
};

}  // namespace plumb::detail
