#include "raster/square_lists.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/round.h"
#include "pixels/tile.h"

namespace plumb::detail {

SquareGrid::SquareGrid(int width, int height, int side_px_in)
    : side_px(side_px_in), columns((width - 1) / side_px + 1), rows((height - 1) / side_px + 1) {}

void SquareLists::clear() {
  added_to_.clear();
  added_.clear();
  entries_.clear();
  begin_ = end_ = 0;
}

void SquareLists::add(std::uint32_t square, WideEntry entry) {
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

namespace {

// The centre of a square's pixels, or a tile's, along one axis.
double centre(int first_px, int side_px) { return first_px + 0.5 * (side_px - 1); }

// With u = 2^-24 and M = |c| + side (|a| + |b|), c the plane's value at the square's centre: the value at a
// tile's centre is computed in float with two sums, two products, and a, b and c rounded: 5 u M. The pixels
// lie within 15.5 of that centre along each axis. For 1/t, two bounds that do not meet must also round to
// different depths: 2 u M more (pixels/tile_planes-inl.h). A value that is not a number leaves the tile open.
void set_planes(const ScreenTriangle& triangle, double x, double y, double side, std::size_t lane,
                WideGroup& group) {
  for (std::size_t k = 0; k < 4; ++k) {
    const double slope = std::fabs(triangle.a[k]) + std::fabs(triangle.b[k]);
    const double value = (triangle.c[k] + triangle.a[k] * x) + triangle.b[k] * y;
    const double rise = 15.502 * slope + double{triangle.error[k]};
    const double raised = value + rise + 0x1p-21 * ((std::fabs(value) + rise) + side * slope);
    group.a[k][lane] = round_to_float(triangle.a[k]);
    group.b[k][lane] = round_to_float(triangle.b[k]);
    group.c[k][lane] = triangle.side_open ? std::numeric_limits<float>::infinity() : round_to_float(raised);
  }
}

// Outside of all.
void set_nothing(std::size_t lane, WideGroup& group) {
  for (std::size_t k = 0; k < 4; ++k) {
    group.a[k][lane] = group.b[k][lane] = 0.0f;
    group.c[k][lane] = -std::numeric_limits<float>::infinity();
  }
}

}  // namespace

void SquareLists::sort_by_depth(const SquareGrid& grid) {
  const auto before = [](const WideEntry& a, const WideEntry& b) { return a.nearest > b.nearest; };
  groups_.clear();
  first_group_.clear();
  for (std::uint32_t square = begin_; square < end_; ++square) {
    const auto begin = entries_.begin() + start_[square - begin_];
    const auto end = entries_.begin() + start_[square - begin_ + 1];
    std::sort(begin, end, before);
    first_group_.push_back(static_cast<std::uint32_t>(groups_.size()));
    const auto column = static_cast<int>(square) % grid.columns,
               row = static_cast<int>(square) / grid.columns;
    const double x = centre(column * grid.side_px, grid.side_px),
                 y = centre(row * grid.side_px, grid.side_px);
    const auto count = static_cast<std::size_t>(end - begin);
    for (std::size_t i = 0; i < (count + WideGroup::kSize - 1) / WideGroup::kSize * WideGroup::kSize; ++i) {
      const std::size_t lane = i % WideGroup::kSize;
      if (lane == 0) groups_.emplace_back();
      if (i < count) {
        set_planes(*begin[static_cast<std::ptrdiff_t>(i)].triangle, x, y, grid.side_px, lane, groups_.back());
      } else {
        set_nothing(lane, groups_.back());
      }
    }
  }
}

SortedList SquareLists::sorted_list(const SquareGrid& grid, int x, int y) const {
  const std::size_t square = grid.at(x, y);
  const std::span<const WideEntry> entries = list(square);
  if (entries.empty()) return {};
  const auto offset = [&](int tile) {
    return static_cast<float>(centre(tile, kTilePx) -
                              centre(tile / grid.side_px * grid.side_px, grid.side_px));
  };
  return {entries, groups_.data() + first_group_[square - begin_], offset(x), offset(y)};
}

std::span<const WideEntry> SquareLists::list(std::size_t square) const {
  if (square < begin_ || square >= end_) return {};
  const std::size_t first = start_[square - begin_];
  return std::span<const WideEntry>(entries_).subspan(first, start_[square - begin_ + 1] - first);
}

// A counting sort by the leading bits of `nearest`, whose bits as integers order as the numbers do.
void order_by_depth(std::span<const WideEntry> entries, std::vector<WideEntry>& sorted) {
  if (entries.empty()) return;
  constexpr std::uint32_t kBuckets = 32;
  std::uint32_t least = 0xffffffffu, greatest = 0;
  for (const WideEntry& entry : entries) {
    const auto bits = std::bit_cast<std::uint32_t>(entry.nearest);
    least = std::min(least, bits);
    greatest = std::max(greatest, bits);
  }
  int shift = 0;
  while ((greatest - least) >> shift >= kBuckets) ++shift;
  const auto bucket = [&](const WideEntry& entry) {
    return (greatest - std::bit_cast<std::uint32_t>(entry.nearest)) >> shift;
  };
  std::size_t start[kBuckets + 1] = {};
  for (const WideEntry& entry : entries) ++start[bucket(entry) + 1];
  for (std::uint32_t b = 0; b < kBuckets; ++b) start[b + 1] += start[b];
  const std::size_t base = sorted.size();
  sorted.resize(base + entries.size());
  for (const WideEntry& entry : entries) sorted[base + start[bucket(entry)]++] = entry;
}

}  // namespace plumb::detail
