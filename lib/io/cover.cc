#include "io/cover.h"

#include <utility>

namespace plumb::detail {

Cover::Cover(const std::vector<Corners>& triangles, std::vector<std::uint32_t> mates, bool with_backs)
    : triangles_(triangles), fronts_(static_cast<std::uint32_t>(mates.size())), mates_(std::move(mates)) {
  if (!with_backs) return;
  mates_.resize(2 * mates_.size(), kNoMate);
  for (std::uint32_t a = 0; a < fronts_; ++a) {
    const std::uint32_t b = mates_[a];
    if (b < a || b >= fronts_) continue;  // seen from b already, or there is none
    const bool runs_the_same_way = position(a) == position(b);
    set_mates(a, runs_the_same_way ? back_of(b) : b);
    set_mates(back_of(a), runs_the_same_way ? b : back_of(b));
  }
}

std::uint32_t Cover::position(std::uint32_t corner) const {
  if (corner < fronts_) return triangles_[corner / 3][corner % 3];
  const std::uint32_t back = corner - fronts_;
  return triangles_[back / 3][(3 - back % 3) % 3];
}

DisjointSets Cover::fans() const {
  DisjointSets fans(mates_.size());
  for (std::uint32_t a = 0; a < mates_.size(); ++a) {
    const std::uint32_t b = mates_[a];
    if (b == kNoMate || b < a) continue;
    fans.join(a, next_corner(b));
    fans.join(next_corner(a), b);
  }
  return fans;
}

// Side k of the back runs along side 2 - k of the front.
std::uint32_t Cover::back_of(std::uint32_t side) const { return fronts_ + side - side % 3 + (2 - side % 3); }

void Cover::set_mates(std::uint32_t a, std::uint32_t b) {
  mates_[a] = b;
  mates_[b] = a;
}

}  // namespace plumb::detail
