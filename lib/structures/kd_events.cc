#include "structures/kd_events.h"

#include <algorithm>
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

void split_events(std::span<const KdEvent> events, const KdSide* side, const std::size_t kept[2],
                  const KdEvents fresh[2], KdEvents halves[2]) {
  // By side, those of cut triangles to nowhere: which way an event goes is too hard to predict for a branch.
  // One more is there for a write that stays.
  KdEvent nowhere;
  KdEvent* to[3] = {&nowhere, nullptr, nullptr};
  for (const int half : {0, 1}) {
    halves[half].resize(std::min(2 * kept[half], events.size()) + fresh[half].size() + 1);
    to[half + 1] = halves[half].data();
  }
  for (const KdEvent& event : events) {
    const auto where = static_cast<std::size_t>(side[event.triangle()]);
    *to[where] = event;
    to[where] += where != 0 ? 1 : 0;
  }
  for (const int half : {0, 1}) {
    KdEvents& all = halves[half];
    KdEvent* const begin = all.data();
    KdEvent* end = to[half + 1];
    all.resize(static_cast<std::size_t>(end - begin) + fresh[half].size());
    // The few fresh ones push the others back, from the last on.
    KdEvent* out = all.data() + all.size();
    for (std::size_t i = fresh[half].size(); i-- > 0;) {
      KdEvent* const place = std::upper_bound(begin, end, fresh[half][i]);
      out = std::move_backward(place, end, out);
      *--out = fresh[half][i];
      end = place;
    }
  }
}

}  // namespace plumb::detail
