#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "pixels/screen_triangle.h"
#include "plumb/mesh.h"
#include "raster/kernels.h"
#include "raster/projection.h"

namespace plumb::detail {

/// The tiles of a frame, row by row.
struct TileGrid {
  int columns, rows;

  TileGrid(int width, int height);
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// Triangles set up, and which tiles each may touch: filled batch by batch, its memory kept.
class Bins {
 public:
  /// Triangles of a batch: their records stay within some ten MiB.
  static constexpr std::size_t kBatch = std::size_t{1} << 16;

  Bins(const Projection& projection, const RasterKernels& kernels);

  /// Sets up and sorts the mesh's triangles from `first` to before `last`, at most kBatch, on up to
  /// `threads` threads. The result does not depend on how many.
  void fill(MeshView mesh, std::size_t first, std::size_t last, int threads);

  const TileGrid& grid() const { return grid_; }
  const ScreenTriangle* triangles() const { return triangles_.get(); }
  /// The tiles that may be touched lie from this to before end_tile().
  std::size_t begin_tile() const { return begin_tile_; }
  std::size_t end_tile() const { return end_tile_; }

  /// Triangles that touch many tiles: in every tile's list.
  const std::vector<BinEntry>& wide() const { return wide_; }
  std::size_t chunks() const { return chunks_.size(); }
  /// Those of one chunk that may touch the tile.
  std::span<const BinEntry> list(std::size_t chunk, std::size_t tile) const;

 private:
  // A part of the batch, set up by one thread: its triangles, and per tile from begin_tile on a list of them.
  struct Chunk {
    std::size_t first, count;  // in triangles_
    std::size_t begin_tile, end_tile;
    std::vector<std::uint32_t> start;
    std::vector<BinEntry> entries;
    std::vector<BinEntry> wide;
    std::vector<std::uint32_t> tile_of;  // while sorting
    std::vector<BinEntry> unsorted;
  };

  void add_to_chunk(Chunk& chunk, std::uint32_t index) const;
  void sort_chunk(Chunk& chunk) const;

  const Projection& projection_;
  const RasterKernels& kernels_;
  TileGrid grid_;
  std::unique_ptr<ScreenTriangle[]> triangles_;
  std::size_t capacity_ = 0;
  std::size_t begin_tile_ = 0, end_tile_ = 0;
  std::vector<Chunk> chunks_;
  std::vector<BinEntry> wide_;
};

}  // namespace plumb::detail
