#pragma once

#include <algorithm>
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
/// written once; only the runs are sorted by tile, in the end.
class TileLists {
 public:
  /// Empties the lists of so many tiles; keeps the store.
  void reset(std::size_t tiles);

  void add(std::uint32_t tile, const TileEntry& entry) {
    Tail& tail = tails_[tile];
    if (tail.filled == kRunEntries) grow(tile);
    run(tail.run)[tail.filled++] = entry;
    tail.nearest = std::max(tail.nearest, entry.nearest);
  }

  /// Bytes of the runs in use.
  std::size_t bytes() const { return used_ * kRunEntries * sizeof(TileEntry); }

  /// Ends all lists: nothing more is added.
  void finish();
  /// Appends a tile's runs, in the order of adding; after finish().
  void collect(std::size_t tile, std::vector<EntryRun>& to) const;

 private:
  static constexpr std::uint32_t kRunEntries = 20;
  static constexpr std::uint32_t kRunsAPiece = 256;

  // The last run of a tile's list; none where run is kNoRun.
  struct Tail {
    std::uint32_t run = kNoRun;
    std::uint32_t filled = kRunEntries;
    float nearest = 0.0f;
  };
  static constexpr std::uint32_t kNoRun = 0xffffffffu;

  struct TileRun {
    std::uint32_t tile;
    Tail of;
  };

  TileEntry* run(std::uint32_t index) const {
    return pieces_[index / kRunsAPiece].get() + index % kRunsAPiece * kRunEntries;
  }
  void grow(std::uint32_t tile);

  std::vector<Tail> tails_;
  std::vector<std::unique_ptr<TileEntry[]>> pieces_;
  std::size_t used_ = 0;            // runs
  std::vector<TileRun> ended_;      // in the order of ending
  std::vector<Tail> runs_;          // by tile
  std::vector<std::size_t> begin_;  // of each tile's among them, and their end
};

}  // namespace plumb::detail
