#pragma once

#include <algorithm>
#include <cmath>

#include "plumb/ray.h"
#include "structures/grid_scene.h"

namespace plumb::detail {

/// Cells from lo to hi on each axis.
struct GridCells {
  int lo[3], hi[3];
};

/// Slabs to walk through: first, first + step, ... before end.
struct GridSpan {
  int first, end, step;
};

enum class GridWalk {
  kInside,   ///< the ray may be in these cells of the slab
  kOutside,  ///< it is not in the slab at a t that counts
  kBeyond,   ///< nor in any slab that comes later
};

/// A valid ray's walk through a grid, slab by slab across one axis, in double, u = 2^-53.
///
/// What has to be shown: let p be the exact point of a hit that counts, at t. Let cell i of an axis be the
/// greatest whose beginning, as index() defines it, is not above p there. Then the walk comes to slab i of
/// its axis and takes the other axes' cells i of p among those that it lists. For by monotonicity the
/// triangle's own range of cells has each of these (its box holds p), and its plane, which p lies on, does
/// not take them out.
///
/// The slab's ends are known to within GridAxis::slack(). The t at an end, (plane - o) / d, is rounded three
/// times, an error of less than 4 u |plane - o| / |d|: as if the plane were off by 4 u (|plane| + |o|). Both
/// are less than `slack_` of the axis, by which the ends are moved outwards, so that the computed interval
/// holds t. Over it the coordinate of another axis, o + t d, is off by 3 u (|o| + |t d|), for which twice
/// that is allowed and which index() takes to a cell not beyond p's. All is in double's range: |t| < 2^278.
class GridRay {
 public:
  GridRay(const Ray& ray, const GridScene& scene)
      : axes_(scene.axis), tmin_(ray.tmin > 0.0f ? double{ray.tmin} : 0.0) {
    double most = -1.0;
    for (int a = 0; a < 3; ++a) {
      origin_[a] = double{ray.origin[a]};
      direction_[a] = double{ray.direction[a]};
      slack_[a] = axes_[a].slack() +
                  0x1p-49 * (std::fabs(origin_[a]) + std::fabs(axes_[a].lo) + std::fabs(axes_[a].hi));
      // Planes met in a unit of t; an axis of one cell counts least, but must do where the ray moves along no
      // other.
      const double rate = std::fabs(direction_[a]) * axes_[a].inverse_step;
      if (direction_[a] != 0.0 && rate > most) {
        most = rate;
        main_ = a;
      }
    }
    inverse_ = 1.0 / direction_[main_];
  }

  /// The slabs that the ray may meet; false when it does not meet the grid's box up to `limit`.
  bool begin(float limit, GridSpan& span) const {
    double first = tmin_, last = double{limit};
    for (int a = 0; a < 3; ++a) {
      const double lo = axes_[a].lo - slack_[a], hi = axes_[a].hi + slack_[a];
      if (direction_[a] == 0.0) {
        if (origin_[a] < lo || origin_[a] > hi) return false;
        continue;
      }
      const double inverse = 1.0 / direction_[a];
      const double at_lo = (lo - origin_[a]) * inverse, at_hi = (hi - origin_[a]) * inverse;
      first = std::max(first, std::min(at_lo, at_hi));
      last = std::min(last, std::max(at_lo, at_hi));
    }
    if (!(first <= last)) return false;
    const bool forward = direction_[main_] > 0.0;
    const GridAxis& axis = axes_[main_];
    const double from = origin_[main_] + first * direction_[main_];
    const double off = reach(main_, first);
    span.step = forward ? 1 : -1;
    span.first = axis.index(forward ? from - off : from + off);
    span.end = forward ? axis.cells : -1;
    return true;
  }

  /// The cells of a slab that the ray may come through at a t from tmin to `limit`.
  GridWalk slab(int i, float limit, GridCells& cells) const {
    const GridAxis& axis = axes_[main_];
    const double lo = (axis.plane(i) - slack_[main_] - origin_[main_]) * inverse_;
    const double hi = (axis.plane(i + 1) + slack_[main_] - origin_[main_]) * inverse_;
    const double first = std::max(tmin_, std::min(lo, hi)), last = std::min(double{limit}, std::max(lo, hi));
    if (first > double{limit}) return GridWalk::kBeyond;
    if (!(first <= last)) return GridWalk::kOutside;
    cells.lo[main_] = cells.hi[main_] = i;
    for (const int a : {(main_ + 1) % 3, (main_ + 2) % 3}) {
      const double from = origin_[a] + first * direction_[a], to = origin_[a] + last * direction_[a];
      const double off = reach(a, last);
      const double least = std::min(from, to) - off, greatest = std::max(from, to) + off;
      if (greatest < axes_[a].lo || least > axes_[a].hi) return GridWalk::kOutside;
      cells.lo[a] = axes_[a].index(least);
      cells.hi[a] = axes_[a].index(greatest);
    }
    return GridWalk::kInside;
  }

 private:
  // How far the computed o + t d may be off, and the cells' ends with it.
  double reach(int a, double t) const { return slack_[a] + 0x1p-50 * std::fabs(t * direction_[a]); }

  const GridAxis* axes_;
  double origin_[3], direction_[3], slack_[3];
  double inverse_ = 0.0;  // of the main axis
  double tmin_;
  int main_ = 0;
};

}  // namespace plumb::detail
