#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace plumb::detail {

/// A triangle that a tile may see.
struct TileEntry {
  std::uint32_t index;  ///< in the mesh
  float nearest;        ///< no pixel sees it at 1/t above this, with room for the rounding of t
  std::uint32_t box;    ///< pixels of the tile that may see it, both ends included, as pack() has them

  static constexpr std::uint32_t pack(int x0, int y0, int x1, int y1) {
    return static_cast<std::uint32_t>(x0 | y0 << 8 | x1 << 16 | y1 << 24);
  }
  int x0() const { return static_cast<int>(box & 0xff); }
  int y0() const { return static_cast<int>(box >> 8 & 0xff); }
  int x1() const { return static_cast<int>(box >> 16 & 0xff); }
  int y1() const { return static_cast<int>(box >> 24); }
};

/// Entries side by side in a tile's list, and the greatest `nearest` of them.
struct EntryRun {
  float nearest;
  std::span<const TileEntry> entries;
};

/// A list of triangles for each tile. Each grows by runs taken from one store, so that what is added is
/// written once, and nothing is sorted.
class TileLists {
 public:
  /// Entries side by side; a list's runs are full but for the last.
  struct Run {
    static constexpr std::size_t kEntries = 20;
    std::array<TileEntry, kEntries> entry;
    float nearest;
    Run* next;
  };

  /// Empties the lists of so many tiles; keeps the store.
  void reset(std::size_t tiles);

  void add(std::uint32_t tile, const TileEntry& entry) {
    Tail& tail = tails_[tile];
    if (tail.filled == Run::kEntries) grow(tail);
    tail.last->entry[tail.filled++] = entry;
    tail.nearest = std::max(tail.nearest, entry.nearest);
  }

  /// Bytes of the runs in use.
  std::size_t bytes() const { return used_ * sizeof(Run); }

  /// Appends a tile's runs.
  void collect(std::size_t tile, std::vector<EntryRun>& to) const;

 private:
  struct Tail {
    Run* first = nullptr;
    Run* last = nullptr;
    std::uint32_t filled = Run::kEntries;  // entries of the last run
    float nearest = 0.0f;                  // of it
  };
  static constexpr std::size_t kRunsAPiece = 256;

  void grow(Tail& tail);

  std::vector<Tail> tails_;
  std::vector<std::unique_ptr<Run[]>> pieces_;
  std::size_t used_ = 0;  // runs
};

}  // namespace plumb::detail
