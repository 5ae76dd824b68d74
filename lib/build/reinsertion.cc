#include "build/reinsertion.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "build/box.h"

namespace plumb::detail {
namespace {

// Nodes that one search may look at: more than it needs in all but contrived trees.
constexpr int kMostSteps = 2000;
constexpr std::size_t kRoot = 0;

Box join(const Box& a, const Box& b) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(a.lo[axis], b.lo[axis]);
    box.hi[axis] = std::max(a.hi[axis], b.hi[axis]);
  }
  return box;
}

class Optimizer {
 public:
  explicit Optimizer(std::vector<BinaryNode>& nodes)
      : nodes_(nodes), parent_(nodes.size()), area_(nodes.size()) {
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) set_links(i);
  }

  // Nodes of the greatest areas, the greatest first. The root and its children have no other place.
  std::vector<std::uint32_t> widest(std::size_t count) const {
    std::vector<std::uint32_t> list(nodes_.size() - 3);
    std::iota(list.begin(), list.end(), 3u);
    const auto before = [&](std::uint32_t a, std::uint32_t b) {
      return area_[a] > area_[b] || (area_[a] == area_[b] && a < b);
    };
    count = std::min(count, list.size());
    const auto end = list.begin() + static_cast<std::ptrdiff_t>(count);
    std::nth_element(list.begin(), end == list.end() ? end - 1 : end, list.end(), before);
    std::sort(list.begin(), end, before);
    list.resize(count);
    return list;
  }

  double inner_area() const {
    double sum = 0.0;
    for (std::size_t i = 0; i < nodes_.size(); ++i) sum += nodes_[i].count == 0 ? area_[i] : 0.0;
    return sum;
  }

  // Moves the node to where it is best; returns by how much the sum of areas falls.
  double improve(std::uint32_t node) {
    if (parent_[node] == kRoot) return 0.0;
    const Place place = find(node);
    if (place.gain > 0.0) move(node, place.node);
    return place.gain;
  }

 private:
  // A node to become a sibling of, under a new parent in its place.
  struct Place {
    std::uint32_t node = 0;
    double gain = 0.0;
  };
  struct Candidate {
    std::uint32_t node;
    double gain;  // of all nodes but the new parent, if it is here
  };

  // Siblings lie side by side, and the root is alone.
  static std::uint32_t sibling(std::uint32_t node) { return node % 2 == 1 ? node + 1 : node - 1; }

  void set_links(std::uint32_t node) {
    area_[node] = half_area(nodes_[node].box);
    if (nodes_[node].count == 0) parent_[nodes_[node].first] = parent_[nodes_[node].first + 1] = node;
  }

  // From the node's parent up to the root; from each ancestor down into its other child's tree. `gain` is
  // what is won by the removal, less what the nodes down to the candidate grow by.
  Place find(std::uint32_t node) {
    Place best;
    const double own = area_[node];
    const std::uint32_t parent = parent_[node];
    std::uint32_t side = sibling(node);
    std::uint32_t pivot = parent;
    Box without = nodes_[side].box;  // the pivot's box when the node has gone
    double gain = area_[parent];
    int steps = kMostSteps;
    for (;;) {
      stack_.push_back({side, gain});
      while (!stack_.empty()) {
        const Candidate at = stack_.back();
        stack_.pop_back();
        // The new parent is no smaller than the node.
        if (at.gain - own <= best.gain || --steps < 0) continue;
        const double with = half_area(join(nodes_[at.node].box, nodes_[node].box));
        if (at.gain - with > best.gain && at.node != sibling(node)) best = {at.node, at.gain - with};
        if (nodes_[at.node].count != 0) continue;
        const double below = at.gain - (with - area_[at.node]);
        stack_.push_back({nodes_[at.node].first, below});
        stack_.push_back({nodes_[at.node].first + 1, below});
      }
      if (pivot != parent) {
        without = join(without, nodes_[side].box);
        gain += area_[pivot] - half_area(without);
      }
      if (pivot == kRoot) return best;
      side = sibling(pivot);
      pivot = parent_[pivot];
    }
  }

  // The node's sibling takes their parent's place; so two places side by side are free, for the node and
  // the one that it is put beside, whose place their new parent takes.
  void move(std::uint32_t node, std::uint32_t beside) {
    const std::uint32_t parent = parent_[node];
    const std::uint32_t free = std::min(node, sibling(node));
    const BinaryNode moved = nodes_[node];
    nodes_[parent] = nodes_[sibling(node)];
    set_links(parent);
    nodes_[free] = moved;
    nodes_[free + 1] = nodes_[beside];
    set_links(free);
    set_links(free + 1);
    nodes_[beside] = {join(nodes_[free].box, nodes_[free + 1].box), free, 0};
    set_links(beside);
    refit(parent_[parent]);
    if (beside != kRoot) refit(parent_[beside]);
  }

  void refit(std::uint32_t node) {
    for (;;) {
      const std::uint32_t first = nodes_[node].first;
      nodes_[node].box = join(nodes_[first].box, nodes_[first + 1].box);
      area_[node] = half_area(nodes_[node].box);
      if (node == kRoot) return;
      node = parent_[node];
    }
  }

  std::vector<BinaryNode>& nodes_;
  std::vector<std::uint32_t> parent_;
  std::vector<double> area_;
  std::vector<Candidate> stack_;
};

// The nodes and triangles as builders lay them out; false if a path is too deep.
bool lay_out(const std::vector<BinaryNode>& nodes, const std::vector<std::uint32_t>& order,
             BinaryTree& tree) {
  struct Step {
    std::uint32_t from, to;
    int depth;
  };
  std::vector<Step> stack{{0, 0, 1}};
  BinaryTree result;
  result.unseen = tree.unseen;
  result.nodes.reserve(nodes.size());
  result.order.reserve(order.size());
  result.nodes.resize(1);
  while (!stack.empty()) {
    const Step step = stack.back();
    stack.pop_back();
    if (step.depth > kMaxTreeDepth) return false;
    BinaryNode node = nodes[step.from];
    if (node.count != 0) {
      const auto first = order.begin() + node.first;
      node.first = static_cast<std::uint32_t>(result.order.size());
      result.order.insert(result.order.end(), first, first + node.count);
    } else {
      const auto first = static_cast<std::uint32_t>(result.nodes.size());
      result.nodes.resize(result.nodes.size() + 2);
      stack.push_back({node.first + 1, first + 1, step.depth + 1});
      stack.push_back({node.first, first, step.depth + 1});
      node.first = first;
    }
    result.nodes[step.to] = node;
  }
  tree = std::move(result);
  return true;
}

}  // namespace

void reinsert(BinaryTree& tree, const ReinsertionOptions& options, Progress& progress, std::size_t steps) {
  const DefaultFpMode guard;
  constexpr std::size_t kFewest = 7;  // nodes below that have no other place
  if (tree.nodes.size() < kFewest || options.passes == 0) {
    progress.add(steps);
    return;
  }
  std::vector<BinaryNode> nodes = tree.nodes;
  Optimizer optimizer(nodes);
  const double before = optimizer.inner_area();
  const auto passes = static_cast<std::size_t>(options.passes);
  std::size_t done = 0;
  for (std::size_t pass = 0; pass < passes; ++pass) {
    const float share = pass == 0 ? options.share * 0.2f : options.share;
    const auto count = static_cast<std::size_t>(share * static_cast<float>(nodes.size())) + 16;
    double gain = 0.0;
    const std::vector<std::uint32_t> widest = optimizer.widest(count);
    for (std::size_t i = 0; i < widest.size(); ++i) {
      gain += optimizer.improve(widest[i]);
      if (i % 1024 != 0) continue;
      const std::size_t now = steps * (pass * widest.size() + i) / (passes * widest.size());
      if (now > done && !progress.add(now - done)) return;
      done = std::max(done, now);
    }
    if (!(gain > static_cast<double>(options.least_gain) * before)) break;
  }
  progress.add(steps - done);
  lay_out(nodes, tree.order, tree);
}

}  // namespace plumb::detail
