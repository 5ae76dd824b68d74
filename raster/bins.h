#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "plumb/mesh.h"
#include "raster/projection.h"
#include "raster/triangle_setup.h"

namespace plumb::detail {

/// The tiles of a frame, row by row.
struct TileGrid {
  int columns, rows;

  TileGrid(int width, int height);
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// Triangles set up, and which tiles each may touch.
class Bins {
 public:
  /// Sets up the mesh's triangles from `first` to before `last`, on up to `threads` threads. The result does
  /// not depend on how many.
  Bins(const Projection& projection, const glm::vec3& eye, const TileGrid& grid, MeshView mesh,
       std::size_t first, std::size_t last, int threads);

  const std::vector<TriangleSetup>& records() const { return records_; }
  /// Indices into records() of those that may touch the tile.
  std::span<const std::uint32_t> list(std::size_t tile) const {
    return std::span<const std::uint32_t>(entries_).subspan(start_[tile], start_[tile + 1] - start_[tile]);
  }
  /// Tiles whose list is not empty.
  const std::vector<std::uint32_t>& touched() const { return touched_; }

 private:
  std::vector<TriangleSetup> records_;
  std::vector<std::uint32_t> entries_;
  std::vector<std::size_t> start_;
  std::vector<std::uint32_t> touched_;
};

}  // namespace plumb::detail
