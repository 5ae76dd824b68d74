#include "wide/wide_cuts.h"

#include <algorithm>
#include <cstddef>

#include "build/box.h"

namespace plumb::detail {
namespace {

// What a node costs whatever its area, of which the root's costs 1: where areas say nothing, the fewest nodes
// are made.
constexpr float kEachNode = 1e-7f;

constexpr std::size_t at(int children) { return static_cast<std::size_t>(children - 1); }

// The cheapest way to share out `most` children between two nodes, and how many the first has.
template <typename Costs>
struct Shares {
  float cost;
  int first = 1;

  Shares(const Costs& left, const Costs& right, int most) : cost(left[0] + right[at(most - 1)]) {
    for (int k = 2; k < most; ++k) {
      const float c = left[at(k)] + right[at(most - k)];
      if (c < cost) {
        cost = c;
        first = k;
      }
    }
  }
};

}  // namespace

template <int W>
WideCuts<W>::WideCuts(const BinaryTree& tree) : tree_(tree), costs_(tree.nodes.size()) {
  if (tree.nodes.empty()) return;
  const double root = half_area(tree.nodes[0].box);
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const BinaryNode& node = tree.nodes[i];
    Costs& costs = costs_[i];
    if (node.count != 0) {
      costs.fill(0.0f);
      continue;
    }
    const Costs& left = costs_[node.first];
    const Costs& right = costs_[node.first + 1];
    const double area = root > 0.0 ? half_area(node.box) / root : 0.0;
    costs[0] = static_cast<float>(area) + kEachNode + Shares(left, right, W).cost;
    for (int k = 2; k < W; ++k) costs[at(k)] = std::min(costs[at(k - 1)], Shares(left, right, k).cost);
  }
}

template <int W>
typename WideCuts<W>::Children WideCuts<W>::children(std::uint32_t node) const {
  Children children;
  if (tree_.nodes[node].count != 0) {
    children.node[0] = node;
    children.count = 1;
  } else {
    open(tree_.nodes[node], W, children);
  }
  return children;
}

template <int W>
void WideCuts<W>::gather(std::uint32_t index, int most, Children& children) const {
  const Costs& costs = costs_[index];
  while (most > 1 && costs[at(most - 1)] <= costs[at(most)]) --most;
  if (most == 1) {
    children.node[static_cast<std::size_t>(children.count++)] = index;
  } else {
    open(tree_.nodes[index], most, children);
  }
}

template <int W>
void WideCuts<W>::open(const BinaryNode& node, int most, Children& children) const {
  const Shares shares(costs_[node.first], costs_[node.first + 1], most);
  gather(node.first, shares.first, children);
  gather(node.first + 1, most - shares.first, children);
}

template class WideCuts<4>;
template class WideCuts<8>;

}  // namespace plumb::detail
