#include "raster/square_lists.h"

#include <algorithm>
#include <bit>

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

void SquareLists::sort_by_depth() {
  const auto before = [](const WideEntry& a, const WideEntry& b) { return a.nearest > b.nearest; };
  for (std::uint32_t square = begin_; square < end_; ++square) {
    const auto begin = entries_.begin() + start_[square - begin_];
    std::sort(begin, entries_.begin() + start_[square - begin_ + 1], before);
  }
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
