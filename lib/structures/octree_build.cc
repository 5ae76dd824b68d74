#include "structures/octree_build.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "build/box.h"
#include "build/clip_triangle.h"
#include "exact/intersect.h"

namespace plumb::detail {
namespace {

// References that a triangle may come to have, on the average of its path.
constexpr double kMostCopies = 8.0;
// A cell of up to so many is a leaf.
constexpr std::size_t kLeaf = kOctreeLanes;

// A triangle's part in a cell.
struct Part {
  std::uint32_t index;
  Box box;  // holds the part
};

float middle_of(float lo, float hi) { return static_cast<float>(0.5 * (double{lo} + double{hi})); }

class Builder {
 public:
  Builder(MeshView mesh, Progress& progress) : mesh_(mesh), progress_(progress) {}

  OctreeParts run() {
    std::vector<Part> parts = finite_triangles();
    tree_.triangles = parts.size();
    if (parts.empty()) return std::move(tree_);
    tree_.nodes.emplace_back();
    build(0, tree_.box, std::move(parts), 1.0, 1);
    progress_.throw_if_cancelled();
    return std::move(tree_);
  }

 private:
  Triangle triangle(std::uint32_t index) const {
    const glm::uvec3& corners = mesh_.triangles[index];
    return {mesh_.positions[corners.x], mesh_.positions[corners.y], mesh_.positions[corners.z]};
  }

  std::vector<Part> finite_triangles() {
    std::vector<Part> parts;
    parts.reserve(mesh_.triangles.size());
    tree_.box = empty_box();
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const auto index = static_cast<std::uint32_t>(i);
      const Triangle t = triangle(index);
      if (!triangle_is_finite(t)) continue;
      parts.push_back({index, box_of(t)});
      for (int axis = 0; axis < 3; ++axis) {
        tree_.box.lo[axis] = std::min(tree_.box.lo[axis], parts.back().box.lo[axis]);
        tree_.box.hi[axis] = std::max(tree_.box.hi[axis], parts.back().box.hi[axis]);
      }
    }
    return parts;
  }

  void make_leaf(std::uint32_t node, const std::vector<Part>& parts, double share) {
    tree_.nodes[node].first = static_cast<std::uint32_t>(tree_.order.size());
    tree_.nodes[node].count = static_cast<std::uint32_t>(parts.size());
    for (const Part& part : parts) tree_.order.push_back(part.index);
    done_ += share;
    if (done_ >= 1024.0) {
      progress_.add(static_cast<std::size_t>(done_));
      done_ = 0.0;
    }
  }

  // The parts that each child has. What lies in the middle plane goes to the lower half alone.
  void distribute(const std::vector<Part>& parts, const Box& cell, const glm::vec3& middle,
                  std::array<std::vector<Part>, 8>& children) const {
    std::array<Box, 8> boxes;
    for (int i = 0; i < 8; ++i) boxes[static_cast<std::size_t>(i)] = octree_child(cell, middle, i);
    for (const Part& part : parts) {
      int lower = 0, upper = 0;  // axes, one bit each, on whose sides it has points
      for (int axis = 0; axis < 3; ++axis) {
        if (part.box.lo[axis] <= middle[axis]) lower |= 1 << axis;
        if (part.box.hi[axis] > middle[axis]) upper |= 1 << axis;
      }
      // A part that one plane cuts has points on either side, two planes may leave corners empty.
      const bool must_clip = (lower & upper & ((lower & upper) - 1)) != 0;
      for (int i = 0; i < 8; ++i) {
        if ((i & ~upper) != 0 || (~i & 7 & ~lower) != 0) continue;
        Part child = part;
        const auto k = static_cast<std::size_t>(i);
        if (must_clip) {
          if (!clip_triangle(triangle(part.index), boxes[k], child.box)) continue;
        } else {
          for (int axis = 0; axis < 3; ++axis) {
            child.box.lo[axis] = std::max(child.box.lo[axis], boxes[k].lo[axis]);
            child.box.hi[axis] = std::min(child.box.hi[axis], boxes[k].hi[axis]);
          }
        }
        children[k].push_back(child);
      }
    }
  }

  // `copies` is how many times as many references the path has as triangles came in.
  void build(std::uint32_t node, const Box& cell, std::vector<Part> parts, double copies, int depth) {
    const double share = static_cast<double>(parts.size()) / copies;
    if (parts.size() <= kLeaf || depth == kMaxOctreeDepth || progress_.cancelled()) {
      make_leaf(node, parts, share);
      return;
    }
    glm::vec3 middle;
    for (int axis = 0; axis < 3; ++axis) middle[axis] = middle_of(cell.lo[axis], cell.hi[axis]);
    std::array<std::vector<Part>, 8> children;
    distribute(parts, cell, middle, children);
    std::size_t sum = 0;
    for (const std::vector<Part>& child : children) sum += child.size();
    const double growth = static_cast<double>(sum) / static_cast<double>(parts.size());
    const bool is_flat = middle == cell.lo || middle == cell.hi;
    if (copies * growth > kMostCopies || is_flat) {
      make_leaf(node, parts, share);
      return;
    }
    parts = {};
    const auto first = static_cast<std::uint32_t>(tree_.nodes.size());
    tree_.nodes.resize(tree_.nodes.size() + 8);
    tree_.nodes[node] = {middle, first, OctreeNode::kInner};
    for (int i = 0; i < 8; ++i) {
      std::vector<Part>& child = children[static_cast<std::size_t>(i)];
      build(first + static_cast<std::uint32_t>(i), octree_child(cell, middle, i), std::move(child),
            copies * growth, depth + 1);
    }
  }

  MeshView mesh_;
  Progress& progress_;
  OctreeParts tree_;
  double done_ = 0.0;  // triangles not yet told
};

}  // namespace

OctreeParts build_octree(MeshView mesh, Progress& progress) { return Builder(mesh, progress).run(); }

}  // namespace plumb::detail
