#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pixels/screen_triangle.h"

namespace plumb::detail {

/// A frame cut into squares, row by row.
struct SquareGrid {
  int side_px, columns, rows;

  SquareGrid(int width, int height, int side_px);
  /// The number of the square that holds the pixel.
  std::size_t at(int x, int y) const {
    const int column = x / side_px, row = y / side_px;
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
           static_cast<std::size_t>(column);
  }
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// A wide triangle in a square's list.
struct WideEntry {
  const ScreenTriangle* triangle;
  float nearest;  ///< ScreenTriangle::nearest
};

/// Sixteen triangles of a square's list, for tiles of it to pass over those that they certainly do not see. A
/// tile whose centre lies (x, y) pixels from the square's is outside a triangle where one of a x + b y + c is
/// below 0, or the last below a 1/t that hides it: the planes are ScreenTriangle's about the square's centre,
/// c being raised by all that one can rise in the tile and by every error.
struct WideGroup {
  static constexpr std::size_t kSize = 16;
  alignas(64) float a[4][kSize];
  alignas(64) float b[4][kSize];
  alignas(64) float c[4][kSize];
};

/// A square's list as one of its tiles sees it.
struct SortedList {
  std::span<const WideEntry> entries;  ///< from front to back
  const WideGroup* groups;             ///< of theirs, kSize at a time
  float x, y;                          ///< of the tile's centre from the square's
};

/// Lists of triangles, one for each square that has some.
class SquareLists {
 public:
  void clear();
  void add(std::uint32_t square, WideEntry entry);
  /// Orders what was added by square.
  void sort();
  /// Orders each square's list from front to back, and groups it.
  void sort_by_depth(const SquareGrid& grid);

  std::span<const WideEntry> list(std::size_t square) const;
  /// The list of the square that the tile with the upper left pixel (x, y) lies in; after sort_by_depth().
  SortedList sorted_list(const SquareGrid& grid, int x, int y) const;

 private:
  std::vector<std::uint32_t> added_to_;
  std::vector<WideEntry> added_;
  // The squares with a list that is not empty lie from begin_ to before end_.
  std::uint32_t begin_ = 0, end_ = 0;
  std::vector<std::uint32_t> start_;
  std::vector<WideEntry> entries_;
  std::vector<WideGroup> groups_;
  std::vector<std::uint32_t> first_group_;  // of each of those squares
};

/// Appends the entries to `sorted`, roughly from front to back.
void order_by_depth(std::span<const WideEntry> entries, std::vector<WideEntry>& sorted);

}  // namespace plumb::detail
