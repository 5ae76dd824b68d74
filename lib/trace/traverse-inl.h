// One ray through a wide tree: the loop, for every tree, arithmetic, query and Highway target. A node's
// boxes are tested at once, and the children met are taken near to far.

#if defined(PLUMB_TRACE_TRAVERSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_TRAVERSE_INL_H_
#undef PLUMB_TRACE_TRAVERSE_INL_H_
#else
#define PLUMB_TRACE_TRAVERSE_INL_H_
#endif

#include <cstdint>
#include <utility>

#include "build/binary_tree.h"
#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "trace/query.h"
#include "trace/tree_blocks-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

struct WideTraversalEntry {
  float near;  // no point of it is nearer
  std::uint32_t child;
  std::uint32_t count;  // triangles of a leaf; 0 for a node
};

// An arithmetic is a class of tests, made for a ray:
//     boxes(node, limit, near)     the children that may hold a hit up to `limit`, one bit each, and the
//                                  distance that no hit of a child is nearer than
//     leaf(blocks, count, query)   offers the hits of a leaf's triangles to the query; true when the
//                                  query is done
// `current` is where the ray starts, the root unless told. Vectors in the tests hold min(W, lanes of the
// target) lanes, so W = 8 takes one step on AVX2 and two on SSE4 or NEON.
template <class Tree, class Tests, class Query>
HWY_INLINE void Traverse(const Tree& tree, Tests& tests, Query& query,
                         WideTraversalEntry current = {0.0f, 0, 0}) {
  constexpr int W = Tree::kWidth;
  // Every node visited leaves at most W - 1 siblings on the stack.
  WideTraversalEntry stack[(W - 1) * kMaxTreeDepth + 1];
  WideTraversalEntry* top = stack;
  // What waits on the stack is fetched meanwhile.
  const auto prefetch = [&](const WideTraversalEntry& entry) HWY_ATTR {
    if (entry.count != 0) {
      hwy::Prefetch(AddressOfBlock(tree, entry.child));
    } else {
      hwy::Prefetch(&tree.nodes[entry.child]);
    }
  };
  for (;;) {
    if (current.count != 0) {
      query.count_triangles(current.count);
      if (TestLeaf(tree, current.child, current.count, tests, query)) return;
    } else {
      const WideNode<W>& node = tree.nodes[current.child];
      query.count_volumes(W);
      HWY_ALIGN float near[W];
      std::uint32_t met = tests.boxes(node, query.limit(), near);
      const auto entry_of = [&](std::uint32_t bits) HWY_ATTR -> WideTraversalEntry {
        const auto i = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
        return {near[i], node.child[i], node.count[i]};
      };
      if (met != 0) {
        WideTraversalEntry nearest = entry_of(met);
        met &= met - 1;
        if constexpr (!Query::kOrdered) {
          // Any order will do.
          for (; met != 0; met &= met - 1) {
            *top = entry_of(met);
            prefetch(*top++);
          }
          current = nearest;
          continue;
        }
        // Mostly one or two are met, and the nearest comes next: it need not go by the stack.
        if (met == 0) {
          current = nearest;
          continue;
        }
        WideTraversalEntry second = entry_of(met);
        met &= met - 1;
        if (second.near < nearest.near) std::swap(nearest, second);
        WideTraversalEntry* const base = top;
        *top++ = second;
        prefetch(second);
        for (; met != 0; met &= met - 1) {
          WideTraversalEntry entry = entry_of(met);
          if (entry.near < nearest.near) std::swap(nearest, entry);
          prefetch(entry);
          WideTraversalEntry* place = top++;
          for (; place != base && place[-1].near < entry.near; --place) *place = place[-1];
          *place = entry;
        }
        current = nearest;
        continue;
      }
    }
    do {
      if (top == stack) return;
      current = *--top;
    } while (current.near > query.limit());
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
