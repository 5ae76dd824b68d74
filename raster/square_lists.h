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
  std::size_t size() const { return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows); }
};

/// A wide triangle in a square's list.
struct WideEntry {
  const ScreenTriangle* triangle;
  float nearest;  ///< ScreenTriangle::nearest
};

/// Lists of triangles, one for each square that has some.
class SquareLists {
 public:
  void clear();
  void add(std::uint32_t square, WideEntry entry);
  /// Orders what was added by square.
  void sort();
  /// Orders each square's list from front to back.
  void sort_by_depth();

  std::span<const WideEntry> list(std::size_t square) const;

 private:
  std::vector<std::uint32_t> added_to_;
  std::vector<WideEntry> added_;
  // The squares with a list that is not empty lie from begin_ to before end_.
  std::uint32_t begin_ = 0, end_ = 0;
  std::vector<std::uint32_t> start_;
  std::vector<WideEntry> entries_;
};

/// Appends the entries to `sorted`, roughly from front to back.
void order_by_depth(std::span<const WideEntry> entries, std::vector<WideEntry>& sorted);

}  // namespace plumb::detail
