#include "build/tree_check.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "build/clip_triangle.h"
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
  for (std::uint32_t i = 0; i < node.count; ++i) {
    const std::uint32_t triangle = tree.order[node.first + i];
    if (census.count(triangle, box, where, violations)) census.note_box(triangle, index, node.box);
  }
}

// Whether the boxes cover the part of the triangle in the cell, which is cut at their planes until each piece
// is in one of them or in none. Pieces that clip_triangle leaves only for its rounding are within `slack` of
// a box.
bool cover_cell(const Triangle& triangle, const Box& cell, const std::vector<Box>& boxes,
                const glm::dvec3& slack) {
  Box part;
  if (!clip_triangle(triangle, cell, part)) return true;
  for (const Box& box : boxes) {
    bool inside = true;
    for (int axis = 0; axis < 3; ++axis) {
      inside = inside && double{part.lo[axis]} >= double{box.lo[axis]} - slack[axis] &&
               double{part.hi[axis]} <= double{box.hi[axis]} + slack[axis];
    }
    if (inside) return true;
  }
  for (const Box& box : boxes) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const float plane : {box.lo[axis], box.hi[axis]}) {
        if (!(plane > part.lo[axis] && plane < part.hi[axis])) continue;
        Box below = part, above = part;
        below.hi[axis] = above.lo[axis] = plane;
        return cover_cell(triangle, below, boxes, slack) && cover_cell(triangle, above, boxes, slack);
      }
    }
  }
  return false;
}

bool cover(const Triangle& triangle, const std::vector<Box>& boxes) {
  const Box own = box_of(triangle);
  glm::dvec3 slack;
  for (int axis = 0; axis < 3; ++axis)
    slack[axis] = 0x1p-20 * double{std::max(std::fabs(own.lo[axis]), std::fabs(own.hi[axis]))} + 0x1p-145;
  return cover_cell(triangle, own, boxes, slack);
}

}  // namespace

bool within(const Box& inner, const Box& outer) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(inner.lo[axis] >= outer.lo[axis] && inner.hi[axis] <= outer.hi[axis])) return false;
  }
  return true;
}

void Census::check_parts(Violations& violations) {
  std::sort(parts_.begin(), parts_.end(), [](const Part& a, const Part& b) {
    return a.triangle < b.triangle || (a.triangle == b.triangle && a.leaf < b.leaf);
  });
  std::vector<Box> boxes;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const std::uint32_t triangle = parts_[i].triangle;
    const bool more = i + 1 < parts_.size() && parts_[i + 1].triangle == triangle;
    if (more && parts_[i + 1].leaf == parts_[i].leaf)
      violations.add("triangle ", triangle, " is twice in leaf ", parts_[i].leaf);
    boxes.push_back(parts_[i].box);
    if (more) continue;
    if (!cover({corner(triangle, 0), corner(triangle, 1), corner(triangle, 2)}, boxes))
      violations.add("triangle ", triangle, " is not covered by the boxes of its leaves");
    boxes.clear();
  }
}

std::vector<std::string> check_tree(const BinaryTree& tree, MeshView mesh, int max_leaf,
                                    References references) {
  Violations violations;
  Census census(mesh, references);
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
      if (references == References::Several) {
        if (!within(node.box, boxes[i])) violations.add("leaf ", i, " has a box beyond its triangles'");
        boxes[i] = node.box;
      }
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
  if (references == References::Once ? tree.order.size() != mesh.triangles.size() - unseen
                                     : tree.order.size() < mesh.triangles.size() - unseen) {
    violations.add("the order has ", tree.order.size(), " entries for ", mesh.triangles.size() - unseen,
                   " finite triangles");
  }
  return violations.take();
}

}  // namespace plumb::detail
