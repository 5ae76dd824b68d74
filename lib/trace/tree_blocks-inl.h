// The blocks of a tree's leaves, for traversals of either layout. Included once per Highway target.

#if defined(PLUMB_TRACE_TREE_BLOCKS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_TREE_BLOCKS_INL_H_
#undef PLUMB_TRACE_TREE_BLOCKS_INL_H_
#else
#define PLUMB_TRACE_TREE_BLOCKS_INL_H_
#endif

#include <algorithm>
#include <cstdint>

#include "exact/intersect.h"
#include "hwy/highway.h"
#include "trace/compact_block-inl.h"
#include "wide/compact_tree.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

template <int W>
HWY_INLINE Triangle TriangleOf(const TriangleBlock<W>& block, size_t lane) {
  const auto corner = [&](int v) {
    return glm::vec3(block.vertex[v][0][lane], block.vertex[v][1][lane], block.vertex[v][2][lane]);
  };
  return {corner(0), corner(1), corner(2)};
}

// The block at `place`, in the tree or unpacked to `room`.
template <int W>
HWY_INLINE const TriangleBlock<W>& BlockOf(const WideTree<W>& tree, std::uint32_t place, TriangleBlock<W>&) {
  return tree.blocks[place];
}
template <int W>
HWY_INLINE const TriangleBlock<W>& BlockOf(const CompactTree<W>& tree, std::uint32_t place,
                                           TriangleBlock<W>& room) {
  Unpack(tree.block(place), room);
  return room;
}

// The place of the block after that.
template <int W>
HWY_INLINE std::uint32_t NextBlock(const WideTree<W>&, std::uint32_t place) {
  return place + 1;
}
template <int W>
HWY_INLINE std::uint32_t NextBlock(const CompactTree<W>& tree, std::uint32_t place) {
  return tree.next(place);
}

template <int W>
HWY_INLINE const void* AddressOfBlock(const WideTree<W>& tree, std::uint32_t place) {
  return &tree.blocks[place];
}
template <int W>
HWY_INLINE const void* AddressOfBlock(const CompactTree<W>& tree, std::uint32_t place) {
  return tree.block(place);
}

// A triangle, and its id, where all of its block is not needed.
template <int W>
HWY_INLINE Triangle TriangleAt(const WideTree<W>& tree, std::uint32_t place, size_t lane) {
  return TriangleOf(tree.blocks[place], lane);
}
template <int W>
HWY_INLINE Triangle TriangleAt(const CompactTree<W>& tree, std::uint32_t place, size_t lane) {
  return TriangleOf<W>(tree.block(place), lane);
}
template <int W>
HWY_INLINE std::uint32_t IdAt(const WideTree<W>& tree, std::uint32_t place, size_t lane) {
  return tree.blocks[place].id[lane];
}
template <int W>
HWY_INLINE std::uint32_t IdAt(const CompactTree<W>& tree, std::uint32_t place, size_t lane) {
  return IdOf<W>(tree.block(place), lane);
}

// Tests::leaf() for a leaf whose blocks begin at `place`.
template <int W, class Tests, class Query>
HWY_INLINE bool TestLeaf(const WideTree<W>& tree, std::uint32_t place, std::uint32_t count, Tests& tests,
                         Query& query) {
  return tests.leaf(&tree.blocks[place], count, query);
}
template <int W, class Tests, class Query>
HWY_INLINE bool TestLeaf(const CompactTree<W>& tree, std::uint32_t place, std::uint32_t count, Tests& tests,
                         Query& query) {
  for (;; place = tree.next(place)) {
    query.at_block(place);
    TriangleBlock<W> block;
    Unpack(tree.block(place), block);
    const bool done = tests.leaf(&block, std::min<std::uint32_t>(count, W), query);
    query.keep_waiting();
    if (done) return true;
    if (count <= static_cast<std::uint32_t>(W)) return false;
    count -= static_cast<std::uint32_t>(W);
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
