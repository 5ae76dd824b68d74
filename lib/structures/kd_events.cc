#include "structures/kd_events.h"

#include <limits>

namespace plumb::detail {
namespace {

// The chance that a line which meets a cell meets the part of it up to a plane, or from it on: the ratio of
// their surface areas. A cell that is a line has none; then it is that of their lengths.
class Chances {
 public:
  Chances(const Box& cell, int axis) {
    const auto size = [&](int a) { return double{cell.hi[a]} - double{cell.lo[a]}; };
    const double x = size(axis), y = size((axis + 1) % 3), z = size((axis + 2) % 3);
    const double area = y * z + (y + z) * x;
    const double whole = area > 0.0 ? area : (y + z) + x;
    lo_ = double{cell.lo[axis]};
    hi_ = double{cell.hi[axis]};
    base_ = (area > 0.0 ? y * z : y + z) / whole;
    slope_ = (area > 0.0 ? y + z : 1.0) / whole;
  }

  double below(float plane) const { return base_ + slope_ * (double{plane} - lo_); }
  double above(float plane) const { return base_ + slope_ * (hi_ - double{plane}); }

 private:
  double lo_, hi_, base_, slope_;
};

}  // namespace

KdPlane sweep_planes(std::span<const KdEvent> events, std::size_t count, int axis, const Box& cell,
                     const KdCosts& costs) {
  KdPlane best;
  best.cost = std::numeric_limits<double>::infinity();
  const Chances chances(cell, axis);
  std::size_t below = 0, above = count;
  const auto offer = [&](float place, bool flat_below, std::size_t n_below, std::size_t n_above) {
    double cost =
        costs.node + chances.below(place) * costs.leaf(n_below) + chances.above(place) * costs.leaf(n_above);
    if (n_below == 0 || n_above == 0) cost *= costs.empty;
    if (cost < best.cost) best = {axis, place, flat_below, cost, n_below, n_above};
  };
  for (std::size_t i = 0; i < events.size();) {
    const KdEvent first = events[i];
    std::size_t number[3] = {0, 0, 0};  // by kind
    for (; i < events.size() && events[i].same_place(first); ++i)
      ++number[static_cast<std::size_t>(events[i].kind())];
    const std::size_t flat = number[static_cast<std::size_t>(KdEventKind::Flat)];
    const float place = first.place();
    above -= number[static_cast<std::size_t>(KdEventKind::End)] + flat;
    if (cell.lo[axis] < place && place < cell.hi[axis]) {
      offer(place, true, below + flat, above);
      if (flat != 0) offer(place, false, below, above + flat);
    }
    below += number[static_cast<std::size_t>(KdEventKind::Start)] + flat;
  }
  return best;
}

void classify(std::span<const KdEvent> events, const KdPlane& plane, KdSide* side) {
  for (const KdEvent& event : events) side[event.triangle()] = KdSide::Both;
  for (const KdEvent& event : events) {
    const float place = event.place();
    switch (event.kind()) {
      case KdEventKind::End:
        if (place <= plane.place) side[event.triangle()] = KdSide::Below;
        break;
      case KdEventKind::Start:
        if (place >= plane.place) side[event.triangle()] = KdSide::Above;
        break;
      case KdEventKind::Flat:
        side[event.triangle()] =
            place < plane.place || (place == plane.place && plane.flat_below) ? KdSide::Below : KdSide::Above;
        break;
    }
  }
}

void split_events(std::span<const KdEvent> events, const KdSide* side, const KdEvents fresh[2],
                  KdEvents halves[2]) {
  std::size_t number[4] = {0, 0, 0, 0};  // by side
  for (const KdEvent& event : events) ++number[static_cast<std::size_t>(side[event.triangle()])];
  for (const int half : {0, 1}) {
    const auto kept = static_cast<KdSide>(half + 1);
    KdEvents& to = halves[half];
    to.resize(number[half + 1] + fresh[half].size());
    KdEvent* out = to.data();
    auto next = fresh[half].begin();
    for (const KdEvent& event : events) {
      if (side[event.triangle()] != kept) continue;
      for (; next != fresh[half].end() && *next < event; ++next) *out++ = *next;
      *out++ = event;
    }
    for (; next != fresh[half].end(); ++next) *out++ = *next;
  }
}

}  // namespace plumb::detail
