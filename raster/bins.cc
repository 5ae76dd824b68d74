#include "raster/bins.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "pixels/tile.h"

namespace plumb::detail {
namespace {

// Triangles that a thread sets up at a time.
constexpr std::size_t kChunk = 2048;

struct TileEntry {
  std::uint32_t tile;
  std::uint32_t record;  // in its chunk
};

struct Chunk {
  std::vector<TriangleSetup> records;
  std::vector<TileEntry> entries;
};

// Whether no pixel of the tile can be covered: an edge function is certainly negative in all of it. From
// the tile's centre to a pixel's it grows by at most 15.5 (|a| + |b|).
bool outside_tile(const TriangleSetup& record, int tile_x, int tile_y) {
  constexpr double kHalf = 0.5 * (kTilePx - 1);
  const double x = tile_x * kTilePx + kHalf;
  const double y = tile_y * kTilePx + kHalf;
  const auto negative = [&](const Plane& edge) {
    const double centre = (edge.c + edge.a * x) + edge.b * y;
    return centre + 1.0001 * kHalf * (std::fabs(edge.a) + std::fabs(edge.b)) + edge.error < 0.0;
  };
  return std::any_of(std::begin(record.edge), std::end(record.edge), negative);
}

void bin_record(const TriangleSetup& record, const TileGrid& grid, std::uint32_t index,
                std::vector<TileEntry>& entries) {
  const int column0 = record.x0 / kTilePx, column1 = record.x1 / kTilePx;
  const int row0 = record.y0 / kTilePx, row1 = record.y1 / kTilePx;
  const bool few = column1 - column0 <= 1 && row1 - row0 <= 1;  // the tile itself will find out
  for (int row = row0; row <= row1; ++row) {
    for (int column = column0; column <= column1; ++column) {
      if (!few && outside_tile(record, column, row)) continue;
      entries.push_back({static_cast<std::uint32_t>(row * grid.columns + column), index});
    }
  }
}

Chunk set_up_chunk(const Projection& projection, const glm::vec3& eye, const TileGrid& grid, MeshView mesh,
                   std::size_t first, std::size_t last) {
  Chunk chunk;
  chunk.records.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const glm::uvec3& corner = mesh.triangles[i];
    const Triangle triangle{mesh.positions[corner.x], mesh.positions[corner.y], mesh.positions[corner.z]};
    TriangleSetup records[2];
    const int made = set_up_triangle(projection, eye, triangle, static_cast<std::uint32_t>(i), records);
    for (int k = 0; k < made; ++k) {
      bin_record(records[k], grid, static_cast<std::uint32_t>(chunk.records.size()), chunk.entries);
      chunk.records.push_back(records[k]);
    }
  }
  return chunk;
}

}  // namespace

TileGrid::TileGrid(int width, int height)
    : columns((width - 1) / kTilePx + 1), rows((height - 1) / kTilePx + 1) {}

Bins::Bins(const Projection& projection, const glm::vec3& eye, const TileGrid& grid, MeshView mesh,
           std::size_t first, std::size_t last, int threads) {
  std::vector<Chunk> chunks((last - first + kChunk - 1) / kChunk);
  parallel_for(chunks.size(), threads, [&](std::size_t i) {
    const std::size_t begin = first + i * kChunk;
    chunks[i] = set_up_chunk(projection, eye, grid, mesh, begin, std::min(begin + kChunk, last));
  });

  // Counting sort by tile; within one, in the mesh's order.
  start_.assign(grid.size() + 1, 0);
  std::size_t record_count = 0;
  for (const Chunk& chunk : chunks) {
    for (const TileEntry& entry : chunk.entries) ++start_[entry.tile + 1];
    record_count += chunk.records.size();
  }
  for (std::size_t tile = 0; tile < grid.size(); ++tile) {
    if (start_[tile + 1] != 0) touched_.push_back(static_cast<std::uint32_t>(tile));
    start_[tile + 1] += start_[tile];
  }
  entries_.resize(start_.back());
  records_.reserve(record_count);
  std::vector<std::size_t> next(start_.begin(), start_.end() - 1);
  for (const Chunk& chunk : chunks) {
    const auto base = static_cast<std::uint32_t>(records_.size());
    records_.insert(records_.end(), chunk.records.begin(), chunk.records.end());
    for (const TileEntry& entry : chunk.entries) entries_[next[entry.tile]++] = base + entry.record;
  }
}

}  // namespace plumb::detail
