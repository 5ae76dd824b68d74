#pragma once

#include "base/parallel.h"
#include "build/binary_tree.h"
#include "build/sah_rules.h"
#include "plumb/mesh.h"

namespace plumb::detail {

struct ClusteredSahOptions : SahOptions {
  int threads = 0;
};

/// Pantaleoni and Luebke 2010, "HLBVH: Hierarchical LBVH Construction for Real-Time Ray Tracing of Dynamic
/// Geometry": triangles are sorted along a Morton curve. It is cut into treelets of at most 64 where its
/// cells end, and so are these down to 16 triangles; below, they are cut along the curve where the surface
/// area heuristic says so. build_binned_sah makes a tree over the treelets. Every pass but the sorting's is
/// over few items or memory at hand: it takes about a third of build_binned_sah's time, and rays some percent
/// more.
///
/// Where more than a treelet's triangles share the curve's finest cell, a finer curve goes through that cell;
/// where they share one centre, they are cut by index. Every leaf that may be one is. The tree does not
/// depend on the threads. Errors are those of build_binned_sah; of the options `max_depth` is not asked:
/// paths keep to kMaxTreeDepth.
BinaryTree build_clustered_sah(MeshView mesh, const ClusteredSahOptions& options, Progress& progress);

}  // namespace plumb::detail
