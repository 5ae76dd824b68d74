#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/aligned.h"
#include "build/binary_tree.h"
#include "wide/wide_tree.h"

namespace plumb::detail {

/// Blocks of triangles with each vertex once, for BuildOptions::compact. Neighbours in a mesh share most of
/// theirs: eight triangles have 9 or 10 instead of 24.
///
/// A block takes whole units of 16 bytes, and has
///     uint8    corner[3][W]         which vertex: corner[v][lane]
///     uint8    vertices             up to 3 W
///     (up to a unit's end)
///     uint32   id[W]
///     float    position[3][vertices]   by axes, their bits as they came from the mesh
///     (up to a unit's end)
/// Lanes past the leaf's count have corner 0 and must be masked off.
struct alignas(16) CompactUnit {
  std::array<unsigned char, 16> bytes;
};

template <int W>
struct CompactLayout {
  static constexpr std::size_t kVertices = 3 * W;  // the offset of `vertices`
  static constexpr std::size_t kId = (3 * W + 1 + 15) / 16 * 16;
  static constexpr std::size_t kPosition = kId + 4 * W;

  static std::size_t units(std::size_t vertices) { return (kPosition + 12 * vertices + 15) / 16; }
};

/// A tree of W-wide nodes as WideTree, but WideNode::child of a leaf is the unit at which its first block
/// begins; the others follow.
template <int W>
struct CompactTree {
  static constexpr int kWidth = W;

  UnsetVector<WideNode<W>> nodes;
  UnsetVector<CompactUnit> units;  ///< after the last block some more, which loads may read
  Box box{};                       ///< of all finite triangles; lo > hi when there is none
  float greatest = 0.0f;           ///< greatest |coordinate| among them

  const unsigned char* block(std::uint32_t unit) const { return units[unit].bytes.data(); }
  /// The unit of the block after the one at `unit`.
  std::uint32_t next(std::uint32_t unit) const {
    return unit +
           static_cast<std::uint32_t>(CompactLayout<W>::units(block(unit)[CompactLayout<W>::kVertices]));
  }
};

/// Replaces each number of units by the sum up to it. Throws plumb::Error where that is beyond 32 bits: 64
/// GiB.
void sum_units(std::span<std::uint32_t> units);

/// Takes the tree's nodes, and packs its blocks. The result does not depend on `threads`.
template <int W>
CompactTree<W> compact(WideTree<W> tree, int threads);

extern template CompactTree<8> compact(WideTree<8>, int);

}  // namespace plumb::detail
