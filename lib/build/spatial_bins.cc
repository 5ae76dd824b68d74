#include "build/spatial_bins.h"

#include <algorithm>
#include <limits>

#include "build/sah_bins.h"
#include "build/split_reference.h"

namespace plumb::detail {

void SpatialBins::clear(const Box4& box, int bins) {
  bins_ = bins;
  lo_ = box.lo;
  step_ = scale_ = splat(0.0f);
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = box.hi[axis] - box.lo[axis];
    if (!(extent >= 0x1p-100f && extent <= 0x1p120f)) {
      lo_[axis] = 0.0f;  // so that no difference overflows: infinity * 0 would be no bin
      continue;
    }
    step_[axis] = extent / static_cast<float>(bins);
    scale_[axis] = static_cast<float>(bins) / extent;
  }
  std::fill_n(enter_, bins, Int4{});
  std::fill_n(leave_, bins, Int4{});
  for (int bin = 0; bin < bins; ++bin) std::fill_n(box_[bin], 3, Box4{});
}

void SpatialBins::add(const TriangleRef* refs, std::size_t count, MeshView mesh) {
  const Int4 last = splat(bins_ - 1);
  const auto bin_of = [&](Float4 place) {
    const Int4 bin = truncate((place - lo_) * scale_);
    return select(bin < last, bin, last);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleRef& ref = refs[i];
    const Int4 from = bin_of(ref.lo);
    const Int4 to = bin_of(ref.hi);
    for (int axis = 0; axis < 3; ++axis) {
      ++enter_[from[axis]][axis];
      ++leave_[to[axis]][axis];
      TriangleRef rest = ref;
      for (int bin = from[axis]; bin < to[axis]; ++bin) {
        Box4 left, right;
        estimate_split(mesh, rest, axis, plane(axis, bin + 1), left, right);
        box_[bin][axis].add(left);
        rest.lo = right.lo;
        rest.hi = right.hi;
        rest.set_index(ref.index());
      }
      box_[to[axis]][axis].add(rest.lo, rest.hi);
    }
  }
}

void SpatialBins::add(const SpatialBins& other) {
  for (int bin = 0; bin < bins_; ++bin) {
    enter_[bin] += other.enter_[bin];
    leave_[bin] += other.leave_[bin];
    for (int axis = 0; axis < 3; ++axis) box_[bin][axis].add(other.box_[bin][axis]);
  }
}

SpatialSplit SpatialBins::best_split(Float4 unit, int block_shift) const {
  const std::int32_t round_up = (1 << block_shift) - 1;
  const auto cost_of = [&](const Box4& box, std::int32_t count) {
    return half_area(box, unit) * static_cast<float>((count + round_up) >> block_shift);
  };
  SpatialSplit best;
  best.cost = std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    if (scale_[axis] == 0.0f) continue;
    Box4 right[kMaxSpatialBins];
    std::int32_t right_count[kMaxSpatialBins];
    Box4 box;
    std::int32_t count = 0;
    for (int bin = bins_ - 1; bin > 0; --bin) {
      box.add(box_[bin][axis]);
      count += leave_[bin][axis];
      right[bin] = box;
      right_count[bin] = count;
    }
    box = {};
    count = 0;
    for (int bin = 1; bin < bins_; ++bin) {
      box.add(box_[bin - 1][axis]);
      count += enter_[bin - 1][axis];
      if (count == 0 || right_count[bin] == 0) continue;
      const float cost = cost_of(box, count) + cost_of(right[bin], right_count[bin]);
      if (!(cost < best.cost)) continue;
      best = {axis,
              plane(axis, bin) + 0.0f,
              cost,
              {static_cast<float>(count), static_cast<float>(right_count[bin])},
              {box, right[bin]}};
    }
  }
  return best;
}

void split_references(const TriangleRef* refs, std::size_t count, const SpatialSplit& split, MeshView mesh,
                      Float4 unit, std::vector<TriangleRef>& left, std::vector<TriangleRef>& right) {
  const float area[2] = {half_area(split.box[0], unit), half_area(split.box[1], unit)};
  const float both = area[0] * split.count[0] + area[1] * split.count[1];
  const auto cost_at = [&](int side, const TriangleRef& ref) {
    Box4 box = split.box[side];
    box.add(ref.lo, ref.hi);
    return half_area(box, unit) * split.count[side] + area[1 - side] * (split.count[1 - side] - 1.0f);
  };
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleRef& ref = refs[i];
    if (ref.hi[split.axis] <= split.plane) {
      left.push_back(ref);
    } else if (ref.lo[split.axis] >= split.plane) {
      right.push_back(ref);
    } else {
      const float at_left = cost_at(0, ref), at_right = cost_at(1, ref);
      if (std::min(at_left, at_right) < both) {
        (at_left <= at_right ? left : right).push_back(ref);
        continue;
      }
      TriangleRef parts[2];
      const Sides sides = split_reference(mesh, ref, split.axis, split.plane, parts[0], parts[1]);
      if (sides.left) left.push_back(parts[0]);
      if (sides.right) right.push_back(parts[1]);
    }
  }
}

}  // namespace plumb::detail
