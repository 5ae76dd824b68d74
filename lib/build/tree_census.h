#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "build/box.h"
#include "build/tree_check.h"
#include "plumb/mesh.h"

// What the checks of binary and wide trees share.

namespace plumb::detail {

/// What does not hold, in words.
class Violations {
 public:
  template <typename... Parts>
  void add(const Parts&... parts) {
    if (list_.size() >= kMaxViolations) return;
    std::string text;
    (append(text, parts), ...);
    list_.push_back(std::move(text));
  }
  std::vector<std::string> take() { return std::move(list_); }

 private:
  static void append(std::string& text, const char* part) { text += part; }
  static void append(std::string& text, const std::string& part) { text += part; }
  template <typename Number>
  static void append(std::string& text, Number number) {
    text += std::to_string(number);
  }

  std::vector<std::string> list_;
};

inline bool is_finite(const glm::vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

inline void grow(Box& box, const Box& other) {
  for (int axis = 0; axis < 3; ++axis) {
    box.lo[axis] = std::min(box.lo[axis], other.lo[axis]);
    box.hi[axis] = std::max(box.hi[axis], other.hi[axis]);
  }
}

/// Whether every point of the first is in the second. Defined in tree_check.cc.
bool within(const Box& inner, const Box& outer);

inline bool equal(const Box& a, const Box& b) { return a.lo == b.lo && a.hi == b.hi; }

/// The mesh's triangles and how often a tree has them.
class Census {
 public:
  Census(MeshView mesh, References references)
      : mesh_(mesh), references_(references), seen_(mesh.triangles.size(), 0) {}

  glm::vec3 corner(std::uint32_t triangle, int v) const {
    return mesh_.positions[mesh_.triangles[triangle][v]];
  }
  bool finite(std::uint32_t triangle) const {
    return is_finite(corner(triangle, 0)) && is_finite(corner(triangle, 1)) && is_finite(corner(triangle, 2));
  }

  /// Notes that a leaf has the triangle and grows `box` by it. False if there is no such triangle.
  bool count(std::uint32_t triangle, Box& box, const std::string& where, Violations& violations) {
    if (triangle >= seen_.size()) {
      violations.add(where, " has triangle ", triangle, " of ", seen_.size());
      return false;
    }
    if (seen_[triangle] < 2) ++seen_[triangle];
    if (!finite(triangle)) violations.add(where, " has triangle ", triangle, ", which is not finite");
    for (int v = 0; v < 3; ++v) grow(box, {corner(triangle, v), corner(triangle, v)});
    return true;
  }

  /// Notes which box the leaf has, for all of its triangles that count() has found to be there.
  void note_box(std::uint32_t triangle, std::size_t leaf, const Box& box) {
    if (references_ == References::Several && finite(triangle)) parts_.push_back({triangle, leaf, box});
  }

  /// Reports finite triangles that were not counted once, or that their parts do not cover; returns how many
  /// are not finite.
  std::uint32_t finish(Violations& violations) {
    check_parts(violations);
    std::uint32_t unseen = 0;
    for (std::uint32_t i = 0; i < seen_.size(); ++i) {
      if (!finite(i)) {
        ++unseen;
      } else if (references_ == References::Once ? seen_[i] != 1 : seen_[i] == 0) {
        violations.add("triangle ", i, seen_[i] == 0 ? " is in no leaf" : " is in more than one leaf");
      }
    }
    return unseen;
  }

 private:
  struct Part {
    std::uint32_t triangle;
    std::size_t leaf;
    Box box;
  };

  void check_parts(Violations& violations);

  MeshView mesh_;
  References references_;
  std::vector<std::uint8_t> seen_;
  std::vector<Part> parts_;
};

/// Which nodes were reached from the root, and at what depth. Parents must come first.
class Links {
 public:
  explicit Links(std::size_t nodes) : depth_(nodes, 0) {
    if (nodes != 0) depth_[0] = 1;
  }

  /// Notes that `child` hangs below `parent`. False if that cannot be followed.
  bool link(std::size_t parent, std::size_t child, Violations& violations) {
    if (child >= depth_.size() || child <= parent) {
      violations.add("node ", parent, " has the child ", child, ", which does not come after it among ",
                     depth_.size(), " nodes");
      return false;
    }
    if (depth_[child] != 0) violations.add("node ", child, " is a child twice");
    depth_[child] = depth_[parent] + 1;
    return true;
  }

  void check(std::size_t node, Violations& violations) const {
    if (depth_[node] == 0) violations.add("node ", node, " is no node's child");
    if (depth_[node] > kMaxTreeDepth) violations.add("node ", node, " lies too deep, at ", depth_[node]);
  }

 private:
  std::vector<int> depth_;
};

}  // namespace plumb::detail
