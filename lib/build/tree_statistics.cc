#include "build/tree_statistics.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "build/box.h"

namespace plumb::detail {
namespace {

// Sums over a tree's nodes, which come with their parents first.
class Sums {
 public:
  Sums(int width, const Box& root, std::size_t nodes) : root_area_(half_area(root)), depth_(nodes, 1) {
    statistics_.width = width;
  }

  void node(const Box& box, int children) {
    ++statistics_.nodes;
    children_ += static_cast<std::size_t>(children);
    statistics_.sah_cost += chance(box) * children;
  }
  void leaf(const Box& box, std::size_t triangles, std::size_t lanes, int depth) {
    ++statistics_.leaves;
    triangles_ += triangles;
    lanes_ += lanes;
    statistics_.sah_cost += chance(box) * static_cast<double>(triangles);
    statistics_.depth = std::max(statistics_.depth, depth);
  }
  int& depth(std::size_t node) { return depth_[node]; }

  Statistics finish(std::size_t bytes) {
    const auto share = [](std::size_t part, std::size_t whole) {
      return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
    };
    statistics_.fill = share(children_, statistics_.nodes * static_cast<std::size_t>(statistics_.width));
    statistics_.leaf_fill = share(triangles_, lanes_);
    statistics_.bytes = bytes;
    return statistics_;
  }

 private:
  double chance(const Box& box) const { return root_area_ > 0.0 ? half_area(box) / root_area_ : 1.0; }

  Statistics statistics_;
  double root_area_;
  std::vector<int> depth_;
  std::size_t children_ = 0;
  std::size_t triangles_ = 0;
  std::size_t lanes_ = 0;
};

template <typename Vector>
std::size_t bytes_of(const Vector& vector) {
  return vector.capacity() * sizeof(vector[0]);
}

}  // namespace

Statistics tree_statistics(const BinaryTree& tree) {
  Sums sums(2, tree.nodes.empty() ? Box{} : tree.nodes[0].box, tree.nodes.size());
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const BinaryNode& node = tree.nodes[i];
    if (node.count != 0) {
      sums.leaf(node.box, node.count, node.count, sums.depth(i));
    } else {
      sums.node(node.box, 2);
      sums.depth(node.first) = sums.depth(node.first + 1) = sums.depth(i) + 1;
    }
  }
  return sums.finish(bytes_of(tree.nodes) + bytes_of(tree.order));
}

template <int W>
Statistics tree_statistics(const WideTree<W>& tree) {
  const std::size_t count = tree.nodes.size();
  Sums sums(W, tree.box, count);
  std::vector<Box> boxes(count, tree.box);  // of each node, from its parent
  for (std::size_t i = 0; i < count; ++i) {
    const WideNode<W>& node = tree.nodes[i];
    int used = 0;
    for (; used < W && node.child[used] != kNoChild; ++used) {
      const Box box{{node.bounds[0][used], node.bounds[2][used], node.bounds[4][used]},
                    {node.bounds[1][used], node.bounds[3][used], node.bounds[5][used]}};
      const std::uint32_t child = node.child[used];
      const std::size_t triangles = node.count[used];
      if (triangles != 0) {
        sums.leaf(box, triangles, (triangles + W - 1) / W * W, sums.depth(i) + 1);
      } else {
        boxes[child] = box;
        sums.depth(child) = sums.depth(i) + 1;
      }
    }
    sums.node(boxes[i], used);
  }
  return sums.finish(bytes_of(tree.nodes) + bytes_of(tree.blocks));
}

template Statistics tree_statistics(const WideTree<4>&);
template Statistics tree_statistics(const WideTree<8>&);

}  // namespace plumb::detail
