#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <vector>

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "base/parallel.h"
#include "build/binned_sah.h"
#include "build/box.h"
#include "plumb/mesh.h"

// What the tests of builders ask of their trees.

namespace build_scenes {

using plumb::TriangleMesh;
using plumb::detail::BinaryNode;
using plumb::detail::BinaryTree;
using plumb::detail::Box;

inline BinaryTree build(const TriangleMesh& mesh, const plumb::detail::BinnedSahOptions& options = {}) {
  plumb::detail::Progress progress(nullptr, mesh.triangles.size());
  return plumb::detail::build_binned_sah(mesh, options, progress);
}

/// What a check returns as one text; empty when all holds.
inline std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "; ";
  return text;
}

/// Whether the trees are equal to the bit.
inline bool same(const BinaryTree& a, const BinaryTree& b) {
  return a.unseen == b.unseen && a.order == b.order && a.nodes.size() == b.nodes.size() &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BinaryNode)) == 0;
}

inline glm::dvec3 doubled_centre(const TriangleMesh& mesh, std::uint32_t triangle) {
  glm::dvec3 lo(mesh.positions[mesh.triangles[triangle].x]);
  glm::dvec3 hi = lo;
  for (int v = 1; v < 3; ++v) {
    const glm::dvec3 p(mesh.positions[mesh.triangles[triangle][v]]);
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  return lo + hi;
}

inline Box box_of(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles) {
  Box box = plumb::detail::empty_box();
  for (const std::uint32_t triangle : triangles) {
    for (int v = 0; v < 3; ++v) {
      box.lo = glm::min(box.lo, mesh.positions[mesh.triangles[triangle][v]]);
      box.hi = glm::max(box.hi, mesh.positions[mesh.triangles[triangle][v]]);
    }
  }
  return box;
}

/// What a split costs, its node apart.
inline double sah_cost(const TriangleMesh& mesh, std::span<const std::uint32_t> left,
                       std::span<const std::uint32_t> right) {
  return plumb::detail::half_area(box_of(mesh, left)) * static_cast<double>(left.size()) +
         plumb::detail::half_area(box_of(mesh, right)) * static_cast<double>(right.size());
}

/// The triangles below each node.
inline std::vector<std::span<const std::uint32_t>> triangles_below(const BinaryTree& tree) {
  std::vector<std::span<const std::uint32_t>> below(tree.nodes.size());
  for (std::size_t i = tree.nodes.size(); i-- > 0;) {
    const BinaryNode& node = tree.nodes[i];
    below[i] = node.count != 0 ? std::span(tree.order).subspan(node.first, node.count)
                               : std::span(below[node.first].data(),
                                           below[node.first].size() + below[node.first + 1].size());
  }
  return below;
}

}  // namespace build_scenes
