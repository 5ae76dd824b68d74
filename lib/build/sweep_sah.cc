#include "build/sweep_sah.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "build/box.h"
#include "build/triangle_refs.h"

// Three lists hold all triangles, each sorted along an axis by the centres of boxes. A range of them is
// the same triangles in each list. A split cuts one list and moves the triangles of both sides together in
// the other two, which keeps these sorted.

namespace plumb::detail {
namespace {

struct Range {
  std::size_t begin, end;
  int depth;  // nodes from the root to this one, both counted
  Box box;

  std::size_t size() const { return end - begin; }
};

struct Cut {
  int axis = -1;
  std::size_t left = 0;  // triangles on the left
  double cost = std::numeric_limits<double>::infinity();
  std::size_t imbalance = 0;
};

class Builder {
 public:
  Builder(const SweepSahOptions& options, Progress& progress, MeshView mesh);
  BinaryTree run();

 private:
  std::span<std::uint32_t> list(int axis, const Range& range);
  void grow(Box& box, std::uint32_t item) const;
  void sweep(int axis, const Range& range, Cut& best);
  bool choose(const Range& range, Cut& cut);
  void split(const Range& range, const Cut& cut, Range halves[2]);
  void build(std::size_t self, const Range& range);
  void make_leaf(std::size_t self, const Range& range);

  const SweepSahOptions& options_;
  const SahRules rules_;
  Progress& progress_;
  TriangleRefs refs_;
  std::array<std::vector<std::uint32_t>, 3> sorted_;  // indices into refs_
  std::vector<double> right_cost_;                    // of the triangles from a place of the range on
  std::vector<std::uint8_t> goes_left_;               // by index into refs_
  std::vector<std::uint32_t> right_side_;
  BinaryTree tree_;
};

// A sum of two floats fits a double: it neither overflows nor underflows.
double doubled_centre(const TriangleRef& ref, int axis) {
  return double{ref.lo[axis]} + double{ref.hi[axis]};
}

Builder::Builder(const SweepSahOptions& options, Progress& progress, MeshView mesh)
    : options_(options),
      rules_(options, "SweepSahOptions"),
      progress_(progress),
      refs_(make_triangle_refs(mesh)),
      right_cost_(refs_.count),
      goes_left_(refs_.count) {
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<std::uint32_t>& sorted = sorted_[static_cast<std::size_t>(axis)];
    sorted.resize(refs_.count);
    std::iota(sorted.begin(), sorted.end(), 0u);
    std::stable_sort(sorted.begin(), sorted.end(), [&](std::uint32_t a, std::uint32_t b) {
      return doubled_centre(refs_.refs[a], axis) < doubled_centre(refs_.refs[b], axis);
    });
  }
}

std::span<std::uint32_t> Builder::list(int axis, const Range& range) {
  return std::span(sorted_[static_cast<std::size_t>(axis)]).subspan(range.begin, range.size());
}

void Builder::grow(Box& box, std::uint32_t item) const {
  const TriangleRef& ref = refs_.refs[item];
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], ref.lo[axis]);
    box.hi[axis] = std::max(box.hi[axis], ref.hi[axis]);
  }
}

// Finds the cheapest cut of one list; among equals the one that halves it best, then the first.
void Builder::sweep(int axis, const Range& range, Cut& best) {
  const std::span<const std::uint32_t> items = list(axis, range);
  const std::size_t count = items.size();
  const auto cost = [&](const Box& box, std::size_t triangles) {
    return half_area(box) * static_cast<double>(rules_.blocks(triangles));
  };
  Box box = empty_box();
  for (std::size_t i = count; i-- > 1;) {
    grow(box, items[i]);
    right_cost_[i] = cost(box, count - i);
  }
  box = empty_box();
  for (std::size_t left = 1; left < count; ++left) {
    grow(box, items[left - 1]);
    const double sum = cost(box, left) + right_cost_[left];
    const std::size_t imbalance = std::max(left, count - left) - std::min(left, count - left);
    if (sum < best.cost || (sum == best.cost && imbalance < best.imbalance))
      best = {axis, left, sum, imbalance};
  }
}

// False if the range shall be a leaf.
bool Builder::choose(const Range& range, Cut& cut) {
  if (rules_.is_leaf_unsearched(range.size())) return false;
  const bool leaf_allowed = rules_.may_be_leaf(range.size());
  if (!rules_.must_be_halved(range.size(), range.depth)) {
    for (int axis = 0; axis < 3; ++axis) sweep(axis, range, cut);
    // Costs are as in Wald 2007, times the area of the range's box.
    const double area = half_area(range.box);
    const double leaf = options_.triangle_cost * static_cast<double>(rules_.blocks(range.size())) * area;
    return !(leaf_allowed && leaf <= options_.node_cost * area + options_.triangle_cost * cut.cost);
  }
  if (leaf_allowed) return false;
  double longest = -1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = double{range.box.hi[axis]} - double{range.box.lo[axis]};
    if (size <= longest) continue;
    longest = size;
    cut.axis = axis;
  }
  cut.left = rules_.left_half(range.size());
  return true;
}

void Builder::split(const Range& range, const Cut& cut, Range halves[2]) {
  halves[0] = {range.begin, range.begin + cut.left, range.depth + 1, empty_box()};
  halves[1] = {range.begin + cut.left, range.end, range.depth + 1, empty_box()};
  const std::span<const std::uint32_t> cut_list = list(cut.axis, range);
  for (std::size_t i = 0; i < cut_list.size(); ++i) {
    const bool left = i < cut.left;
    goes_left_[cut_list[i]] = left ? 1 : 0;
    grow(halves[left ? 0 : 1].box, cut_list[i]);
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == cut.axis) continue;
    const std::span<std::uint32_t> items = list(axis, range);
    right_side_.clear();
    std::size_t left = 0;
    for (const std::uint32_t item : items) {
      if (goes_left_[item] != 0) {
        items[left++] = item;
      } else {
        right_side_.push_back(item);
      }
    }
    std::copy(right_side_.begin(), right_side_.end(), items.begin() + static_cast<std::ptrdiff_t>(left));
  }
}

void Builder::make_leaf(std::size_t self, const Range& range) {
  const std::span<std::uint32_t> items = list(0, range);
  std::sort(items.begin(), items.end());  // the mesh's order
  for (const std::uint32_t item : items) tree_.order.push_back(refs_.refs[item].index());
  tree_.nodes[self] = {range.box, static_cast<std::uint32_t>(range.begin),
                       static_cast<std::uint32_t>(range.size())};
  progress_.add(range.size());
  progress_.throw_if_cancelled();
}

void Builder::build(std::size_t self, const Range& range) {
  Cut cut;
  if (!choose(range, cut)) {
    make_leaf(self, range);
    return;
  }
  Range halves[2];
  split(range, cut, halves);
  const std::size_t first = tree_.nodes.size();
  tree_.nodes[self] = {range.box, static_cast<std::uint32_t>(first), 0};
  tree_.nodes.resize(first + 2);
  build(first, halves[0]);
  build(first + 1, halves[1]);
}

BinaryTree Builder::run() {
  tree_.unseen = refs_.unseen;
  progress_.add(refs_.unseen);
  progress_.throw_if_cancelled();
  if (refs_.count != 0) {
    tree_.order.reserve(refs_.count);
    tree_.nodes.resize(1);
    build(0, {0, refs_.count, 1, refs_.box.box()});
  }
  return std::move(tree_);
}

}  // namespace

BinaryTree build_sweep_sah(MeshView mesh, const SweepSahOptions& options, Progress& progress) {
  require_tree_size(mesh.triangles.size());
  BinaryTree tree;
  in_arena(1, [&] {
    const DefaultFpMode guard;
    tree = Builder(options, progress, mesh).run();
  });
  return tree;
}

}  // namespace plumb::detail
