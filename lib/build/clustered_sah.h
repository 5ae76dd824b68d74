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
/// Geometry", with treelets of one leaf: triangles are sorted along a Morton curve, which is cut into
/// leaves of at most max_leaf triangles where its cells end, and build_binned_sah makes a tree over the
/// leaves. Faster than build_binned_sah, for a leaf is one item of it, and little worse.
///
/// Where more than a leaf's triangles share the curve's finest cell, a finer curve goes through that cell;
/// where they share one centre, they are cut by index. The tree does not depend on the threads. Errors and
/// the limit of depth are those of build_binned_sah.
BinaryTree build_clustered_sah(MeshView mesh, const ClusteredSahOptions& options, Progress& progress);

}  // namespace plumb::detail
