#include "build/sah_bins.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace plumb::detail {
BinMap::BinMap(const Box4& centres, float unit, int bins)
    : unit_(splat(unit)), origin_(centres.lo), scale_(splat(0.0f)), bins_(bins) {
  // A little less than bins / extent, so that the greatest centre, whatever rounding does, still
  // falls into the last bin.
  const float factor = static_cast<float>(bins) * (1.0f - 0x1p-20f);
  for (int axis = 0; axis < 3; ++axis) {
    const float extent = centres.hi[axis] - centres.lo[axis];
    if (extent >= 0x1p-110f) scale_[axis] = factor / extent;
  }
}

void SahBins::clear(int bins) {
  bins_ = bins;
  std::fill_n(count_, bins, Int4{});
  for (int bin = 0; bin < bins; ++bin) std::fill_n(box_[bin], 3, Box4{});
}

void SahBins::add(const TriangleRef* refs, std::size_t count, const BinMap& map) {
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleRef& ref = refs[i];
    const Int4 bin = map.bin(doubled_centre(ref, map.unit()));
    for (int axis = 0; axis < 3; ++axis) {
      ++count_[bin[axis]][axis];
      box_[bin[axis]][axis].add(ref.lo, ref.hi);
    }
  }
}

void SahBins::add(const SahBins& other) {
  for (int bin = 0; bin < bins_; ++bin) {
    count_[bin] += other.count_[bin];
    for (int axis = 0; axis < 3; ++axis) box_[bin][axis].add(other.box_[bin][axis]);
  }
}

Float4 SahBins::half_areas(const Box4* boxes, Float4 unit) {
  const Float4 a = half_area_terms(boxes[0], unit);
  const Float4 b = half_area_terms(boxes[1], unit);
  const Float4 c = half_area_terms(boxes[2], unit);
  const Float4 low = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Float4 high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  return (__builtin_shufflevector(low, c, 0, 1, 4, 7) + __builtin_shufflevector(low, c, 2, 3, 5, 7)) +
         __builtin_shufflevector(high, c, 0, 1, 6, 7);
}

SahSplit SahBins::best_split(Float4 unit, int block_shift) const {
  const Int4 round_up = splat((1 << block_shift) - 1);
  const auto cost_of = [&](Float4 area, Int4 count) {
    return area * to_float((count + round_up) >> block_shift);
  };

  Float4 right_cost[kMaxBins];
  Box4 swept[3];
  Int4 total{};
  for (int bin = bins_ - 1; bin > 0; --bin) {
    for (int axis = 0; axis < 3; ++axis) swept[axis].add(box_[bin][axis]);
    total += count_[bin];
    right_cost[bin] = cost_of(half_areas(swept, unit), total);
  }
  total += count_[0];

  // One lane an axis. Where a side has no triangle its box is empty, the cost infinity * 0 = NaN,
  // and the comparisons below are false.
  std::fill_n(swept, 3, Box4{});
  Int4 left{};
  Float4 best_cost = splat(std::numeric_limits<float>::infinity());
  Int4 best_imbalance = splat(std::numeric_limits<std::int32_t>::max());
  Int4 best_bin{};
  for (int bin = 1; bin < bins_; ++bin) {
    for (int axis = 0; axis < 3; ++axis) swept[axis].add(box_[bin - 1][axis]);
    left += count_[bin - 1];
    const Float4 cost = cost_of(half_areas(swept, unit), left) + right_cost[bin];
    const Int4 difference = left - (total - left);
    const Int4 imbalance = select(difference < 0, -difference, difference);
    const Int4 better = (cost < best_cost) | ((cost == best_cost) & (imbalance < best_imbalance));
    best_cost = select(better, cost, best_cost);
    best_imbalance = select(better, imbalance, best_imbalance);
    best_bin = select(better, splat(bin), best_bin);
  }

  SahSplit best;
  for (int axis = 0; axis < 3; ++axis) {
    if (best_bin[axis] == 0) continue;
    if (best.axis < 0 || best_cost[axis] < best.cost ||
        (best_cost[axis] == best.cost && best_imbalance[axis] < best_imbalance[best.axis])) {
      best = {axis, best_bin[axis], best_cost[axis]};
    }
  }
  return best;
}

std::size_t SahBins::count_left(const SahSplit& split) const {
  std::size_t count = 0;
  for (int bin = 0; bin < split.bin; ++bin) count += static_cast<std::size_t>(count_[bin][split.axis]);
  return count;
}

void SahBins::boxes(const SahSplit& split, Box4& left, Box4& right) const {
  for (int bin = 0; bin < split.bin; ++bin) left.add(box_[bin][split.axis]);
  for (int bin = split.bin; bin < bins_; ++bin) right.add(box_[bin][split.axis]);
}

void partition(const TriangleRef* refs, std::size_t count, const BinMap& map, const SahSplit& split,
               TriangleRef* left, TriangleRef* right, Box4 centres[2]) {
  Box4 left_centres;
  Box4 right_centres;
  const std::ptrdiff_t right_from_left = right - left;
  std::ptrdiff_t left_count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const TriangleRef ref = refs[i];
    const Float4 centre = doubled_centre(ref, map.unit());
    // By arithmetic on a mask, ones for the right side: a branch would be mispredicted half of the time, and
    // compilers make one of a choice.
    const std::int32_t to_right = (split.bin - 1 - map.bin(centre)[split.axis]) >> 31;
    const std::ptrdiff_t right_count = static_cast<std::ptrdiff_t>(i) - left_count;
    left[left_count + (to_right & (right_from_left + right_count - left_count))] = ref;
    left_count += 1 + to_right;
    // A mask of ones makes the centre NaN, which Box4::add leaves out.
    const Int4 mask = splat(to_right);
    const Float4 left_centre = std::bit_cast<Float4>(std::bit_cast<Int4>(centre) | mask);
    const Float4 right_centre = std::bit_cast<Float4>(std::bit_cast<Int4>(centre) | ~mask);
    left_centres.add(left_centre, left_centre);
    right_centres.add(right_centre, right_centre);
  }
  centres[0] = left_centres;
  centres[1] = right_centres;
}

}  // namespace plumb::detail
