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
  (tail.first == nullptr ? tail.first : tail.last->next) = run;
  tail.last = run;
  tail.filled = 0;
}

}  // namespace plumb::detail
