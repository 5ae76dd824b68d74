#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace plumb::detail {

/// A triangle that a tile may see.
struct TileEntry {
  std::uint32_t index;          ///< in the mesh
  float nearest;                ///< no pixel sees it at 1/t above this, with room for the rounding of t
  std::uint8_t x0, y0, x1, y1;  ///< pixels of the tile that may see it, both ends included
};

/// A list of triangles for each tile. Each grows by runs taken from one store, so that what is added is
/// written once, and nothing is sorted.
class TileLists {
 public:
  /// Entries side by side; a list's runs are full but for the last.
  struct Run {
    static constexpr std::size_t kEntries = 20;
    std::array<TileEntry, kEntries> entry;
    Run* next;
  };

  /// Empties the lists of so many tiles; keeps the store.
  void reset(std::size_t tiles);

  void add(std::uint32_t tile, const TileEntry& entry) {
    Tail& tail = tails_[tile];
    if (tail.filled == Run::kEntries) grow(tail);
    tail.last->entry[tail.filled++] = entry;
  }

  bool empty(std::size_t tile) const { return tails_[tile].first == nullptr; }
  /// Bytes of the runs in use.
  std::size_t bytes() const { return used_ * sizeof(Run); }

  /// Calls visit(std::span<const TileEntry>) for each of a tile's runs.
  template <class Visit>
  void visit(std::size_t tile, const Visit& visit) const {
    const Tail& tail = tails_[tile];
    for (const Run* run = tail.first; run != nullptr; run = run->next) {
      const std::size_t entries = run->next == nullptr ? tail.filled : Run::kEntries;
      visit(std::span<const TileEntry>(run->entry.data(), entries));
    }
  }

 private:
  struct Tail {
    Run* first = nullptr;
    Run* last = nullptr;
    std::size_t filled = Run::kEntries;  // entries of the last run
  };
  static constexpr std::size_t kRunsAPiece = 256;

  void grow(Tail& tail);

  std::vector<Tail> tails_;
  std::vector<std::unique_ptr<Run[]>> pieces_;
  std::size_t used_ = 0;  // runs
};

}  // namespace plumb::detail
