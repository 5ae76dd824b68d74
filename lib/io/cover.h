#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/disjoint_sets.h"

namespace plumb::detail {

/// A triangle by its corners' positions.
using Corners = std::array<std::uint32_t, 3>;

/// Side 3 i + k of triangle i leads from its corner 3 i + k to the next, 3 i + (k + 1) % 3.
inline std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

/// No other side shares a side's edge.
inline constexpr std::uint32_t kNoMate = 0xffffffffu;

/// A surface whose neighbours run along their edge in opposite ways. That is the surface itself where its n
/// triangles agree which side is the front; else its orientable double cover: triangle n + i is the back of
/// triangle i, with the corners 0, 2 and 1, and each front goes on as the front or the back that looks the
/// same way. Whatever is a disk or half a disk in the surface is there twice, so counts are halved.
class Cover {
 public:
  /// `mates` has for each side the one other that shares its edge, whose mate it is in turn, or kNoMate.
  /// The triangles must outlive the cover.
  Cover(const std::vector<Corners>& triangles, std::vector<std::uint32_t> mates, bool with_backs);

  /// Of each side of the cover.
  const std::vector<std::uint32_t>& mates() const { return mates_; }
  /// 1, or 2 with backs.
  std::size_t sheets() const { return fronts_ == mates_.size() ? 1 : 2; }
  /// Of a corner of the cover.
  std::uint32_t position(std::uint32_t corner) const;
  /// The corners that lie about one position and are joined by mates.
  DisjointSets fans() const;

 private:
  std::uint32_t back_of(std::uint32_t side) const;
  void set_mates(std::uint32_t a, std::uint32_t b);

  const std::vector<Corners>& triangles_;
  std::uint32_t fronts_;  // corners that are no backs'
  std::vector<std::uint32_t> mates_;
};

}  // namespace plumb::detail
