#include "raster/tile_lists.h"

namespace plumb::detail {

void TileLists::reset(std::size_t tiles) {
  tails_.assign(tiles, Tail{});
  used_ = 0;
  ended_.clear();
}

void TileLists::grow(std::uint32_t tile) {
  Tail& tail = tails_[tile];
  if (tail.run != kNoRun) ended_.push_back({tile, tail});
  if (used_ == pieces_.size() * kRunsAPiece)
    pieces_.push_back(std::make_unique_for_overwrite<TileEntry[]>(std::size_t{kRunsAPiece} * kRunEntries));
  tail = {static_cast<std::uint32_t>(used_++), 0, 0.0f};
}

// A counting sort.
void TileLists::finish() {
  for (std::size_t tile = 0; tile < tails_.size(); ++tile) {
    if (tails_[tile].run != kNoRun) ended_.push_back({static_cast<std::uint32_t>(tile), tails_[tile]});
  }
  begin_.assign(tails_.size() + 1, 0);
  for (const TileRun& run : ended_) ++begin_[run.tile];
  std::size_t sum = 0;
  for (std::size_t& begin : begin_) {
    sum += begin;
    begin = sum;
  }
  // Each is the end of its tile's runs, and moves down to their beginning.
  runs_.resize(ended_.size());
  for (std::size_t i = ended_.size(); i-- > 0;) runs_[--begin_[ended_[i].tile]] = ended_[i].of;
}

void TileLists::collect(std::size_t tile, std::vector<EntryRun>& to) const {
  for (std::size_t i = begin_[tile]; i < begin_[tile + 1]; ++i)
    to.push_back({runs_[i].nearest, {run(runs_[i].run), runs_[i].filled}});
}

}  // namespace plumb::detail
