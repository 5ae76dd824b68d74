#include "build/tree_check.h"

#include <cstddef>

#include "build/tree_census.h"

namespace plumb::detail {
namespace {

void check_leaf(const BinaryTree& tree, std::size_t index, Census& census, Box& box, Violations& violations) {
  const BinaryNode& node = tree.nodes[index];
  if (node.first > tree.order.size() || node.count > tree.order.size() - node.first) {
    violations.add("leaf ", index, " ends beyond the order's ", tree.order.size(), " entries");
    return;
  }
  const std::string where = "leaf " + std::to_string(index);
  for (std::uint32_t i = 0; i < node.count; ++i)
    census.count(tree.order[node.first + i], box, where, violations);
}

}  // namespace

std::vector<std::string> check_tree(const BinaryTree& tree, MeshView mesh, int max_leaf) {
  Violations violations;
  Census census(mesh);
  Links links(tree.nodes.size());
  std::vector<Box> boxes(tree.nodes.size(), empty_box());
  std::vector<bool> linked(tree.nodes.size(), false);
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) {
    const BinaryNode& node = tree.nodes[i];
    links.check(i, violations);
    if (node.count != 0) {
      if (node.count > static_cast<std::uint32_t>(max_leaf)) {
        violations.add("leaf ", i, " has ", node.count, " triangles, more than ", max_leaf);
      }
      check_leaf(tree, i, census, boxes[i], violations);
    } else {
      const bool left = links.link(i, node.first, violations);
      const bool right = links.link(i, std::size_t{node.first} + 1, violations);
      linked[i] = left && right;
    }
  }
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const BinaryNode& node = tree.nodes[i];
    if (node.count == 0) {
      if (!linked[i]) continue;
      grow(boxes[i], boxes[node.first]);
      grow(boxes[i], boxes[node.first + 1]);
    }
    if (!equal(boxes[i], node.box)) violations.add("node ", i, " has not the box of what is below");
  }
  const std::uint32_t unseen = census.finish(violations);
  if (unseen != tree.unseen) violations.add(unseen, " triangles are not finite, but unseen is ", tree.unseen);
  if (tree.order.size() != mesh.triangles.size() - unseen) {
    violations.add("the order has ", tree.order.size(), " entries for ", mesh.triangles.size() - unseen,
                   " finite triangles");
  }
  return violations.take();
}

}  // namespace plumb::detail
