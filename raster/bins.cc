#include "raster/bins.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "pixels/tile.h"

namespace plumb::detail {
namespace {

// Triangles that a thread sets up at a time.
constexpr std::size_t kChunk = 4096;

// A triangle that may touch more tiles than this is in no list of a tile's own, which bounds their memory.
constexpr int kMostTiles = 64;

// Whether no pixel of the tile can be covered: an edge function is certainly negative in all of it. From
// the tile's centre to a pixel's it grows by at most 15.5 (|a| + |b|).
bool outside_tile(const ScreenTriangle& triangle, int column, int row) {
  constexpr double kHalf = 0.5 * (kTilePx - 1);
  const double x = column * kTilePx + kHalf;
  const double y = row * kTilePx + kHalf;
  for (int i = 0; i < 3; ++i) {
    const double centre = (triangle.c[i] + triangle.a[i] * x) + triangle.b[i] * y;
    const double rise = 1.0001 * kHalf * (std::fabs(triangle.a[i]) + std::fabs(triangle.b[i]));
    if (centre + rise + double{triangle.error[i]} < 0.0) return true;
  }
  return false;
}

}  // namespace

TileGrid::TileGrid(int width, int height)
    : columns((width - 1) / kTilePx + 1), rows((height - 1) / kTilePx + 1) {}

Bins::Bins(const Projection& projection, const RasterKernels& kernels)
    : projection_(projection), kernels_(kernels), grid_(projection.width, projection.height) {}

void Bins::add_to_chunk(Chunk& chunk, std::uint32_t index) const {
  const ScreenTriangle& triangle = triangles_[index];
  const int column0 = triangle.x0 / kTilePx, column1 = triangle.x1 / kTilePx;
  const int row0 = triangle.y0 / kTilePx, row1 = triangle.y1 / kTilePx;
  const int columns = column1 - column0 + 1, rows = row1 - row0 + 1;
  const BinEntry entry{index, triangle.nearest};
  if (columns > kMostTiles || rows > kMostTiles || columns * rows > kMostTiles) {
    chunk.wide.push_back(entry);
    return;
  }
  const bool few = columns <= 2 && rows <= 2;  // the tile itself will find out
  for (int row = row0; row <= row1; ++row) {
    for (int column = column0; column <= column1; ++column) {
      if (!few && !triangle.side_open && outside_tile(triangle, column, row)) continue;
      chunk.tile_of.push_back(static_cast<std::uint32_t>(row * grid_.columns + column));
      chunk.unsorted.push_back(entry);
    }
  }
}

// A counting sort by tile; within one, in the mesh's order.
void Bins::sort_chunk(Chunk& chunk) const {
  chunk.begin_tile = chunk.end_tile = 0;
  chunk.entries.resize(chunk.unsorted.size());
  if (chunk.tile_of.empty()) return;
  const auto [least, greatest] = std::minmax_element(chunk.tile_of.begin(), chunk.tile_of.end());
  chunk.begin_tile = *least;
  chunk.end_tile = std::size_t{*greatest} + 1;
  chunk.start.assign(chunk.end_tile - chunk.begin_tile + 1, 0);
  for (const std::uint32_t tile : chunk.tile_of) ++chunk.start[tile - chunk.begin_tile];
  std::uint32_t sum = 0;
  for (std::uint32_t& start : chunk.start) {
    sum += start;
    start = sum;
  }
  // Each start is the end of its list, and moves down to its beginning.
  for (std::size_t i = chunk.tile_of.size(); i-- > 0;)
    chunk.entries[--chunk.start[chunk.tile_of[i] - chunk.begin_tile]] = chunk.unsorted[i];
}

void Bins::fill(MeshView mesh, std::size_t first, std::size_t last, int threads) {
  if (triangles_ == nullptr || capacity_ < last - first) {
    capacity_ = last - first;
    triangles_ = std::make_unique_for_overwrite<ScreenTriangle[]>(capacity_);
  }
  chunks_.resize((last - first + kChunk - 1) / kChunk);
  parallel_for(chunks_.size(), threads, [&](std::size_t i) {
    Chunk& chunk = chunks_[i];
    chunk.first = i * kChunk;
    const std::size_t begin = first + chunk.first;
    chunk.count = kernels_.set_up(projection_, mesh, begin, std::min(begin + kChunk, last),
                                  triangles_.get() + chunk.first);
    chunk.wide.clear();
    chunk.tile_of.clear();
    chunk.unsorted.clear();
    for (std::size_t k = 0; k < chunk.count; ++k)
      add_to_chunk(chunk, static_cast<std::uint32_t>(chunk.first + k));
    sort_chunk(chunk);
  });
  wide_.clear();
  begin_tile_ = grid_.size();
  end_tile_ = 0;
  for (const Chunk& chunk : chunks_) {
    wide_.insert(wide_.end(), chunk.wide.begin(), chunk.wide.end());
    if (chunk.begin_tile == chunk.end_tile) continue;
    begin_tile_ = std::min(begin_tile_, chunk.begin_tile);
    end_tile_ = std::max(end_tile_, chunk.end_tile);
  }
  if (!wide_.empty()) {
    begin_tile_ = 0;
    end_tile_ = grid_.size();
  }
}

std::span<const BinEntry> Bins::list(std::size_t chunk_index, std::size_t tile) const {
  const Chunk& chunk = chunks_[chunk_index];
  if (tile < chunk.begin_tile || tile >= chunk.end_tile) return {};
  const std::size_t begin = chunk.start[tile - chunk.begin_tile];
  const std::size_t end = chunk.start[tile - chunk.begin_tile + 1];
  return std::span<const BinEntry>(chunk.entries).subspan(begin, end - begin);
}

}  // namespace plumb::detail
