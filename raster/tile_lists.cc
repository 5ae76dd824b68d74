#include "raster/tile_lists.h"

namespace plumb::detail {

void TileLists::reset(std::size_t tiles) {
  tails_.assign(tiles, Tail{});
  used_ = 0;
}

void TileLists::grow(Tail& tail) {
  const std::size_t piece = used_ / kRunsAPiece;
  if (piece == pieces_.size()) pieces_.push_back(std::make_unique_for_overwrite<Run[]>(kRunsAPiece));
  Run* const run = &pieces_[piece][used_ % kRunsAPiece];
  ++used_;
  run->next = nullptr;
  if (tail.first == nullptr) {
    tail.first = run;
  } else {
    tail.last->next = run;
    tail.last->nearest = tail.nearest;
  }
  tail.last = run;
  tail.filled = 0;
  tail.nearest = 0.0f;
}

void TileLists::collect(std::size_t tile, std::vector<EntryRun>& to) const {
  const Tail& tail = tails_[tile];
  for (const Run* run = tail.first; run != nullptr; run = run->next) {
    if (run->next != nullptr) {
      to.push_back({run->nearest, run->entry});
    } else {
      to.push_back({tail.nearest, std::span<const TileEntry>(run->entry).first(tail.filled)});
    }
  }
}

}  // namespace plumb::detail
