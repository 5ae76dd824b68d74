#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "build/binary_tree.h"

// Where the triangles of a cell begin and end along an axis: what Wald and Havran 2006 sort once, and keep
// sorted from a cell to its halves.

namespace plumb::detail {

/// At one place ends come first and starts last, so that a sweep can tell what lies in the plane.
enum class KdEventKind : std::uint32_t { End, Flat, Start };

/// A place where a triangle's box ends or starts along an axis, or where it lies flat. Packed into one number
/// whose order is that of places, then kinds, then triangles.
class KdEvent {
 public:
  static constexpr std::uint32_t kTriangles = 1u << 30;  ///< indices are below

  KdEvent() = default;
  KdEvent(float place, KdEventKind kind, std::uint32_t triangle)
      : bits_(std::uint64_t{ordered(place)} << 32 | static_cast<std::uint32_t>(kind) << 30 | triangle) {}

  float place() const {
    const auto word = static_cast<std::uint32_t>(bits_ >> 32);
    return std::bit_cast<float>((word & kSign) != 0 ? word ^ kSign : ~word);
  }
  KdEventKind kind() const { return static_cast<KdEventKind>(bits_ >> 30 & 3u); }
  std::uint32_t triangle() const { return static_cast<std::uint32_t>(bits_) & (kTriangles - 1); }
  /// Whether a triangle begins here: true for one event of each triangle.
  bool begins() const { return kind() != KdEventKind::End; }
  bool same_place(const KdEvent& other) const { return bits_ >> 32 == other.bits_ >> 32; }

  friend bool operator<(const KdEvent& a, const KdEvent& b) { return a.bits_ < b.bits_; }

 private:
  static constexpr std::uint32_t kSign = 0x80000000u;
  // Floats in the order of integers; 0 and -0 are two places, so boxes must have one of them only.
  static std::uint32_t ordered(float place) {
    const auto word = std::bit_cast<std::uint32_t>(place);
    return (word & kSign) != 0 ? ~word : word | kSign;
  }

  std::uint64_t bits_ = 0;
};

using KdEvents = std::vector<KdEvent>;

/// Appends a triangle's one or two events along an axis, by its part's box.
inline void add_events(KdEvents& events, const Box& box, int axis, std::uint32_t triangle) {
  if (box.lo[axis] == box.hi[axis]) {
    events.emplace_back(box.lo[axis], KdEventKind::Flat, triangle);
  } else {
    events.emplace_back(box.lo[axis], KdEventKind::Start, triangle);
    events.emplace_back(box.hi[axis], KdEventKind::End, triangle);
  }
}

/// What a cell and its halves cost.
struct KdCosts {
  double node = 1.0;   ///< of stepping from a cell to its halves, against...
  double block = 1.0;  ///< ...a test of up to 2^lanes_log2 triangles
  double empty = 1.0;  ///< factor for a plane that cuts off empty space
  int lanes_log2 = 0;

  double leaf(std::size_t triangles) const {
    const std::size_t lanes = std::size_t{1} << lanes_log2;
    return block * static_cast<double>((triangles + lanes - 1) >> lanes_log2);
  }
};

/// A plane that cuts a cell.
struct KdPlane {
  int axis = -1;  ///< none
  float place = 0.0f;
  bool flat_below = false;           ///< triangles that lie in the plane go to the lower half
  double cost = 0.0;                 ///< of the two halves and the step to them
  std::size_t below = 0, above = 0;  ///< triangles
};

/// Finds the cheapest plane across an axis within a cell of `count` triangles, with axis -1 where there is
/// none: planes lie strictly inside. Among equals the first.
KdPlane sweep_planes(std::span<const KdEvent> events, std::size_t count, int axis, const Box& cell,
                     const KdCosts& costs);

/// Where a triangle goes.
enum class KdSide : std::uint8_t { Both, Below, Above };

/// Sets side[triangle] for all triangles of a cell from their events along the plane's axis.
void classify(std::span<const KdEvent> events, const KdPlane& plane, KdSide* side);

/// Moves events along any axis to the halves, keeping the order: those of triangles on one side, of which
/// there are kept[0] below and kept[1] above, merged with fresh[0] and fresh[1], which are sorted.
void split_events(std::span<const KdEvent> events, const KdSide* side, const std::size_t kept[2],
                  const KdEvents fresh[2], KdEvents halves[2]);

}  // namespace plumb::detail
