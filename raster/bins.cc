#include "raster/bins.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "pixels/tile.h"

namespace plumb::detail {
namespace {

// Triangles that a thread sets up at a time.
constexpr std::size_t kChunk = 4096;

// From one grid to the next the side grows by this.
constexpr int kGrowth = 8;

// A triangle that may touch more squares than this goes to the next coarser grid, if there is one.
constexpr std::int64_t kMostSquares = kGrowth * kGrowth;

// Whether no pixel of the square can be covered: an edge function is certainly negative in all of it.
bool outside(const ScreenTriangle& triangle, int side_px, int column, int row) {
  const double side = side_px;
  const double half = 0.5 * (side - 1.0);
  const double x = column * side + half;
  const double y = row * side + half;
  for (int i = 0; i < 3; ++i) {
    const double centre = (triangle.c[i] + triangle.a[i] * x) + triangle.b[i] * y;
    const double rise = 1.0001 * half * (std::fabs(triangle.a[i]) + std::fabs(triangle.b[i]));
    if (centre + rise + double{triangle.error[i]} < 0.0) return true;
  }
  return false;
}

// Appends the entries to `sorted`, roughly from front to back, so that near triangles hide far ones before
// these are drawn: a counting sort by the leading bits of `nearest`, whose bits as integers order as the
// numbers do.
void order_by_depth(const std::vector<BinEntry>& entries, std::vector<BinEntry>& sorted) {
  if (entries.empty()) return;
  constexpr std::uint32_t kBuckets = 32;
  std::uint32_t least = 0xffffffffu, greatest = 0;
  for (const BinEntry& entry : entries) {
    const auto bits = std::bit_cast<std::uint32_t>(entry.nearest);
    least = std::min(least, bits);
    greatest = std::max(greatest, bits);
  }
  int shift = 0;
  while ((greatest - least) >> shift >= kBuckets) ++shift;
  const auto bucket = [&](const BinEntry& entry) {
    return (greatest - std::bit_cast<std::uint32_t>(entry.nearest)) >> shift;
  };
  std::size_t start[kBuckets + 1] = {};
  for (const BinEntry& entry : entries) ++start[bucket(entry) + 1];
  for (std::uint32_t b = 0; b < kBuckets; ++b) start[b + 1] += start[b];
  const std::size_t base = sorted.size();
  sorted.resize(base + entries.size());
  for (const BinEntry& entry : entries) sorted[base + start[bucket(entry)]++] = entry;
}

}  // namespace

SquareGrid::SquareGrid(int width, int height, int side_px_in)
    : side_px(side_px_in), columns((width - 1) / side_px + 1), rows((height - 1) / side_px + 1) {}

void SquareLists::clear() {
  added_to_.clear();
  added_.clear();
  entries_.clear();
  begin_ = end_ = 0;
}

void SquareLists::add(std::uint32_t square, BinEntry entry) {
  added_to_.push_back(square);
  added_.push_back(entry);
}

// A counting sort.
void SquareLists::sort() {
  if (added_.empty()) return;
  const auto [least, greatest] = std::minmax_element(added_to_.begin(), added_to_.end());
  begin_ = *least;
  end_ = *greatest + 1;
  start_.assign(end_ - begin_ + 1, 0);
  for (const std::uint32_t square : added_to_) ++start_[square - begin_];
  std::uint32_t sum = 0;
  for (std::uint32_t& start : start_) {
    sum += start;
    start = sum;
  }
  // Each start is the end of its list, and moves down to its beginning.
  entries_.resize(added_.size());
  for (std::size_t i = added_.size(); i-- > 0;) entries_[--start_[added_to_[i] - begin_]] = added_[i];
}

std::span<const BinEntry> SquareLists::list(std::uint32_t square) const {
  if (square < begin_ || square >= end_) return {};
  const std::size_t first = start_[square - begin_];
  return std::span<const BinEntry>(entries_).subspan(first, start_[square - begin_ + 1] - first);
}

Bins::Bins(const Projection& projection, const RasterKernels& kernels)
    : projection_(projection),
      kernels_(kernels),
      grids_{SquareGrid(projection.width, projection.height, kTilePx),
             SquareGrid(projection.width, projection.height, kTilePx * kGrowth),
             SquareGrid(projection.width, projection.height, kTilePx * kGrowth * kGrowth)} {}

void Bins::add_wide(std::uint32_t index, Lists& lists) const {
  const ScreenTriangle& triangle = wide_[index];
  for (std::size_t g = 0; g < kGrids; ++g) {
    const SquareGrid& grid = grids_[g];
    const int column0 = triangle.x0 / grid.side_px, column1 = triangle.x1 / grid.side_px;
    const int row0 = triangle.y0 / grid.side_px, row1 = triangle.y1 / grid.side_px;
    const std::int64_t squares = std::int64_t{column1 - column0 + 1} * (row1 - row0 + 1);
    if (squares > kMostSquares && g + 1 < kGrids) continue;
    // Of few tiles, each will find out by itself.
    const bool ask = !triangle.side_open && (squares > 4 || g > 0);
    for (int row = row0; row <= row1; ++row) {
      for (int column = column0; column <= column1; ++column) {
        if (ask && outside(triangle, grid.side_px, column, row)) continue;
        lists.wide[g].add(static_cast<std::uint32_t>(row * grid.columns + column),
                          BinEntry(false, index, triangle.nearest));
      }
    }
    return;
  }
}

void Bins::fill_chunk(MeshView mesh, std::size_t first, std::size_t last, std::size_t chunk) {
  const std::size_t offset = chunk * kChunk;
  const BinnedTriangles triangles{placed_.get() + offset, wide_.get() + offset};
  const SetupCounts made =
      kernels_.set_up(projection_, mesh, first + offset, std::min(first + offset + kChunk, last), triangles);
  Lists& lists = chunks_[chunk];
  for (SquareLists& squares : lists.wide) squares.clear();
  lists.placed.clear();
  const auto base = static_cast<std::uint32_t>(offset);
  for (std::uint32_t i = 0; i < made.wide; ++i) add_wide(base + i, lists);
  for (std::uint32_t i = 0; i < made.placed; ++i) {
    const TileTriangle& triangle = triangles.placed[i];
    lists.placed.add(triangle.tile, BinEntry(true, base + i, triangle.nearest));
  }
  for (SquareLists& squares : lists.wide) squares.sort();
  lists.placed.sort();
}

void Bins::cover_tiles(const SquareGrid& grid, const SquareLists& lists) {
  if (lists.begin() == lists.end()) return;
  std::size_t begin = lists.begin(), end = lists.end();
  if (grid.side_px != kTilePx) {  // all tiles of the rows of squares that have any
    const auto columns = static_cast<std::uint32_t>(grid.columns);
    const std::size_t tiles_a_row =
        static_cast<std::size_t>(tiles().columns) * static_cast<std::size_t>(grid.side_px / kTilePx);
    begin = lists.begin() / columns * tiles_a_row;
    end = ((lists.end() - 1) / columns + 1) * tiles_a_row;
  }
  begin_tile_ = std::min(begin_tile_, begin);
  end_tile_ = std::max(end_tile_, std::min(end, tiles().size()));
}

void Bins::fill(MeshView mesh, std::size_t first, std::size_t last, int threads) {
  if (capacity_ < last - first) {
    capacity_ = last - first;
    placed_ = std::make_unique_for_overwrite<TileTriangle[]>(capacity_);
    wide_ = std::make_unique_for_overwrite<ScreenTriangle[]>(capacity_);
  }
  chunks_.resize((last - first + kChunk - 1) / kChunk);
  parallel_for(chunks_.size(), threads, [&](std::size_t i) { fill_chunk(mesh, first, last, i); });
  begin_tile_ = tiles().size();
  end_tile_ = 0;
  for (const Lists& lists : chunks_) {
    for (std::size_t g = 0; g < kGrids; ++g) cover_tiles(grids_[g], lists.wide[g]);
    cover_tiles(tiles(), lists.placed);
  }
}

std::vector<BinEntry> Bins::list(std::size_t tile) const {
  const int column = static_cast<int>(tile % static_cast<std::size_t>(tiles().columns));
  const int row = static_cast<int>(tile / static_cast<std::size_t>(tiles().columns));
  std::vector<BinEntry> wide;
  std::size_t placed = 0;
  for (const Lists& lists : chunks_) {
    for (std::size_t g = 0; g < kGrids; ++g) {
      const int growth = grids_[g].side_px / kTilePx;
      const std::span<const BinEntry> list =
          lists.wide[g].list(static_cast<std::uint32_t>(row / growth * grids_[g].columns + column / growth));
      wide.insert(wide.end(), list.begin(), list.end());
    }
    placed += lists.placed.list(static_cast<std::uint32_t>(tile)).size();
  }
  std::vector<BinEntry> entries;
  entries.reserve(wide.size() + placed);
  order_by_depth(wide, entries);
  for (const Lists& lists : chunks_) {
    const std::span<const BinEntry> list = lists.placed.list(static_cast<std::uint32_t>(tile));
    entries.insert(entries.end(), list.begin(), list.end());
  }
  return entries;
}

}  // namespace plumb::detail
