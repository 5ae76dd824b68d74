#include "raster/bins.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "pixels/tile.h"

namespace plumb::detail {
namespace {

// Triangles that a thread takes at a time.
constexpr std::size_t kChunk = 4096;

// A batch ends when the threads' lists hold so much together: 2.6 million entries, and wide triangles.
constexpr std::size_t kMostBytes = std::size_t{32} << 20;
constexpr std::size_t kMostWide = std::size_t{1} << 16;

// From one grid to the next the side grows by this.
constexpr int kGrowth = 8;

// A triangle that may touch more squares than this goes to the next coarser grid, if there is one.
constexpr std::int64_t kMostSquares[] = {kGrowth * kGrowth, 16};

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

}  // namespace

Bins::Bins(const Projection& projection, const RasterKernels& kernels)
    : projection_(projection),
      kernels_(kernels),
      grids_{SquareGrid(projection.width, projection.height, kTilePx),
             SquareGrid(projection.width, projection.height, kTilePx * kGrowth),
             SquareGrid(projection.width, projection.height, kTilePx * kGrowth * kGrowth)} {}

void Bins::add_wide(const ScreenTriangle& triangle, Slot& slot) const {
  for (std::size_t g = 0; g < kGrids; ++g) {
    const SquareGrid& grid = grids_[g];
    const int column0 = triangle.x0 / grid.side_px, column1 = triangle.x1 / grid.side_px;
    const int row0 = triangle.y0 / grid.side_px, row1 = triangle.y1 / grid.side_px;
    const std::int64_t squares = std::int64_t{column1 - column0 + 1} * (row1 - row0 + 1);
    if (g + 1 < kGrids && squares > kMostSquares[g]) continue;
    // Of few tiles, each will find out by itself.
    const bool ask = !triangle.side_open && (squares > 4 || g > 0);
    for (int row = row0; row <= row1; ++row) {
      for (int column = column0; column <= column1; ++column) {
        if (ask && outside(triangle, grid.side_px, column, row)) continue;
        slot.wide[g].add(static_cast<std::uint32_t>(row * grid.columns + column),
                         {&triangle, triangle.nearest});
      }
    }
    return;
  }
}

std::size_t Bins::fill(MeshView mesh, std::size_t first, std::size_t last, int threads) {
  const std::size_t chunks = (last - first + kChunk - 1) / kChunk;
  const auto most = static_cast<std::size_t>(thread_count(threads));
  slots_.resize(std::max<std::size_t>(std::min(most, chunks), 1));
  std::atomic<std::size_t> next = 0, bytes = 0, wide = 0;
  parallel_for(slots_.size(), threads, [&](std::size_t s) {
    Slot& slot = slots_[s];
    BinnedTriangles& to = slot.triangles;
    to.lists.reset(tiles().size());
    to.wide.clear();
    while (bytes < kMostBytes && wide < kMostWide) {
      const std::size_t chunk = next++;
      if (chunk >= chunks) break;
      const std::size_t begin = first + chunk * kChunk;
      const std::size_t had_bytes = to.lists.bytes(), had_wide = to.wide.size();
      kernels_.bin(projection_, mesh, begin, std::min(begin + kChunk, last), to);
      bytes += to.lists.bytes() - had_bytes;
      wide += to.wide.size() - had_wide;
    }
    to.lists.finish();
    for (SquareLists& lists : slot.wide) lists.clear();
    for (const ScreenTriangle& triangle : to.wide) add_wide(triangle, slot);
    for (SquareLists& lists : slot.wide) lists.sort();
    // A square's list is read by all of its tiles, so it pays to order it well.
    for (std::size_t g = 1; g < kGrids; ++g) slot.wide[g].sort_by_depth(grids_[g]);
  });
  return std::min(first + std::min(next.load(), chunks) * kChunk, last);
}

void Bins::collect(std::size_t tile, TileContents& to) const {
  const int x = static_cast<int>(tile % static_cast<std::size_t>(tiles().columns)) * kTilePx;
  const int y = static_cast<int>(tile / static_cast<std::size_t>(tiles().columns)) * kTilePx;
  for (const Slot& slot : slots_) {
    for (std::size_t g = kGrids - 1; g > 0; --g) {
      const SortedList list = slot.wide[g].sorted_list(grids_[g], x, y);
      if (!list.entries.empty()) to.sorted.push_back(list);
    }
  }
  for (const Slot& slot : slots_) order_by_depth(slot.wide[0].list(tile), to.wide);
  // Neighbours in a mesh mostly lie side by side, so runs are ordered, not triangles: near ones hide far ones
  // before these are set up.
  for (const Slot& slot : slots_) slot.triangles.lists.collect(tile, to.runs);
  std::sort(to.runs.begin(), to.runs.end(),
            [](const EntryRun& a, const EntryRun& b) { return a.nearest > b.nearest; });
}

}  // namespace plumb::detail
