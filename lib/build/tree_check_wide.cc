#include <bit>
#include <cstddef>
#include <cstring>

#include "build/tree_census.h"
#include "build/tree_check.h"

namespace plumb::detail {
namespace {

template <int W>
Box child_box(const WideNode<W>& node, int i) {
  return {{node.bounds[0][i], node.bounds[2][i], node.bounds[4][i]},
          {node.bounds[1][i], node.bounds[3][i], node.bounds[5][i]}};
}

// Whether the extent is a bound, and not a loose one.
bool extent_holds(float extent, const glm::vec3 vertex[3]) {
  double greatest = 0.0;
  for (int v = 1; v < 3; ++v) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) sum += double{std::fabs(vertex[v][axis] - vertex[0][axis])};
    greatest = std::max(greatest, sum);
  }
  const double least = greatest * (1.0 + 2 * 0x1p-24);  // the sum in float, in any order
  const double most = std::max(greatest * (1.0 + 12 * 0x1p-24), 0x1p-30);
  return double{extent} >= least && extent >= 0x1p-30f &&
         (double{extent} <= most || most > double{std::numeric_limits<float>::max()});
}

template <int W>
class WideCheck {
 public:
  WideCheck(const WideTree<W>& tree, MeshView mesh, std::uint32_t first_id, int max_leaf,
            References references)
      : tree_(tree),
        first_id_(first_id),
        max_leaf_(static_cast<std::uint32_t>(max_leaf)),
        references_(references),
        census_(mesh, references),
        links_(tree.nodes.size()),
        block_used_(tree.blocks.size(), false) {}

  std::vector<std::string> run() {
    const std::size_t count = tree_.nodes.size();
    if (count == 0) violations_.add("there is no node");
    std::vector<Children> children(count);
    for (std::size_t i = 0; i < count; ++i) {
      links_.check(i, violations_);
      children[i] = check_node(i);
    }
    // Children come after their parents, so from the end on every box below is known.
    std::vector<Box> boxes(count, empty_box());
    for (std::size_t i = count; i-- > 0;) boxes[i] = check_boxes(i, children[i], boxes);
    for (std::size_t i = 0; i < block_used_.size(); ++i) {
      if (!block_used_[i]) violations_.add("block ", i, " belongs to no leaf");
    }
    census_.finish(violations_);
    if (count != 0) check_whole(boxes[0]);
    return violations_.take();
  }

 private:
  // What can be followed below a node.
  struct Children {
    bool linked[W] = {};
    Box leaf_box[W];
  };

  void check_whole(const Box& box) {
    if (!equal(box, tree_.box)) violations_.add("the tree's box is not that of its triangles");
    const float greatest = greatest_coordinate(box);
    if (greatest != tree_.greatest) violations_.add("greatest is ", tree_.greatest, " instead of ", greatest);
  }

  Children check_node(std::size_t index) {
    const WideNode<W>& node = tree_.nodes[index];
    Children children;
    int used = 0;
    for (int i = 0; i < W; ++i) {
      if (node.child[i] == kNoChild) {
        if (node.count[i] != 0) violations_.add("node ", index, ": the empty child ", i, " has a count");
        continue;
      }
      if (used++ != i) violations_.add("node ", index, ": an empty child comes before child ", i);
      if (node.count[i] == 0) {
        children.linked[i] = links_.link(index, node.child[i], violations_);
      } else {
        children.linked[i] = check_leaf(index, i, children.leaf_box[i]);
        if (references_ == References::Several) {
          const Box box = child_box(node, i);
          if (!within(box, children.leaf_box[i]))
            violations_.add("node ", index, " leaf ", i, " has a box beyond its triangles'");
          children.leaf_box[i] = box;
        }
      }
    }
    if (used == 0 && index != 0) violations_.add("node ", index, " has no child");
    return children;
  }

  bool check_leaf(std::size_t index, int i, Box& box) {
    const std::uint32_t count = tree_.nodes[index].count[i];
    const std::size_t first = tree_.nodes[index].child[i];
    const std::size_t blocks = (std::size_t{count} + W - 1) / W;
    const std::string where = "node " + std::to_string(index) + " leaf " + std::to_string(i);
    if (count > max_leaf_) violations_.add(where, " has ", count, " triangles, more than ", max_leaf_);
    if (first > tree_.blocks.size() || blocks > tree_.blocks.size() - first) {
      violations_.add(where, " ends beyond the ", tree_.blocks.size(), " blocks");
      return false;
    }
    box = empty_box();
    for (std::size_t b = 0; b < blocks; ++b) {
      if (block_used_[first + b]) violations_.add(where, " shares block ", first + b);
      block_used_[first + b] = true;
      for (std::uint32_t lane = 0; lane < W; ++lane) {
        const std::uint32_t place = static_cast<std::uint32_t>(b) * W + lane;
        const std::string at = where + " triangle " + std::to_string(place);
        if (place < count) {
          check_lane(tree_.blocks[first + b], lane, first, child_box(tree_.nodes[index], i), at, box);
        } else if (!is_zero(tree_.blocks[first + b], lane)) {
          violations_.add(at, " lies past the count and is not zero");
        }
      }
    }
    return true;
  }

  void check_lane(const TriangleBlock<W>& block, std::uint32_t lane, std::size_t leaf, const Box& leaf_box,
                  const std::string& where, Box& box) {
    const std::uint32_t index = block.id[lane] - first_id_;
    if (!census_.count(index, box, where, violations_)) return;
    census_.note_box(index, leaf, leaf_box);
    glm::vec3 vertex[3];
    for (int v = 0; v < 3; ++v) {
      vertex[v] = census_.corner(index, v);
      for (int axis = 0; axis < 3; ++axis) {
        if (std::memcmp(&block.vertex[v][axis][lane], &vertex[v][axis], sizeof(float)) != 0) {
          violations_.add(where, " differs from the mesh in vertex ", v, " axis ", axis);
        }
      }
    }
    if (!extent_holds(block.extent[lane], vertex)) {
      violations_.add(where, " has the extent ", block.extent[lane]);
    }
  }

  static bool is_zero(const TriangleBlock<W>& block, std::uint32_t lane) {
    bool zero = block.id[lane] == 0 && std::bit_cast<std::uint32_t>(block.extent[lane]) == 0;
    for (int v = 0; v < 3; ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        zero = zero && std::bit_cast<std::uint32_t>(block.vertex[v][axis][lane]) == 0;
      }
    }
    return zero;
  }

  // Compares the children's boxes with what is below them and joins them.
  Box check_boxes(std::size_t index, const Children& children, const std::vector<Box>& boxes) {
    const WideNode<W>& node = tree_.nodes[index];
    Box all = empty_box();
    for (int i = 0; i < W; ++i) {
      Box expected = empty_box();
      if (node.child[i] != kNoChild) {
        if (!children.linked[i]) continue;
        expected = node.count[i] != 0 ? children.leaf_box[i] : boxes[node.child[i]];
        grow(all, expected);
      }
      if (!equal(child_box(node, i), expected)) {
        violations_.add("node ", index, ": child ", i, " has not the box of what is below");
      }
    }
    return all;
  }

  const WideTree<W>& tree_;
  std::uint32_t first_id_;
  std::uint32_t max_leaf_;
  References references_;
  Violations violations_;
  Census census_;
  Links links_;
  std::vector<bool> block_used_;
};

}  // namespace

template <int W>
std::vector<std::string> check_tree(const WideTree<W>& tree, MeshView mesh, std::uint32_t first_id,
                                    int max_leaf, References references) {
  return WideCheck<W>(tree, mesh, first_id, max_leaf, references).run();
}

template std::vector<std::string> check_tree(const WideTree<4>&, MeshView, std::uint32_t, int, References);
template std::vector<std::string> check_tree(const WideTree<8>&, MeshView, std::uint32_t, int, References);

}  // namespace plumb::detail
