#pragma once

#include "base/parallel.h"
#include "build/binary_tree.h"

namespace plumb::detail {

struct ReinsertionOptions {
  int passes = 3;       ///< at most
  float share = 0.05f;  ///< of the nodes, those of the greatest areas; the first pass takes a fifth of it
  float least_gain = 0.01f;  ///< a pass that lowers the sum of areas by a smaller share is the last
};

/// Bittner, Hapala and Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", with
/// the search of Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization":
/// takes nodes of great areas out of the tree, one after the other, and puts each back where the sum of the
/// inner nodes' areas becomes least. Leaves stay as they are.
///
/// One thread. A search passes over all that the best place found rules out, and may take n time where boxes
/// overlap; so each ends after so many steps that a pass keeps to n. Memory: 40 bytes a node more than the
/// tree. The layout stays depth-first. A tree that would become too deep stays as it was. `progress` is given
/// `steps` and may end it: then the tree is one still, and the caller throws.
void reinsert(BinaryTree& tree, const ReinsertionOptions& options, Progress& progress, std::size_t steps);

}  // namespace plumb::detail
