#pragma once

#include "base/parallel.h"
#include "build/binary_tree.h"
#include "build/sah_rules.h"
#include "build/triangle_refs.h"
#include "plumb/mesh.h"

namespace plumb::detail {

struct BinnedSahOptions : SahOptions {
  int bins = 32;  ///< per axis, 8 to 32; small nodes take fewer
  int threads = 0;
};

/// Wald 2007, "On fast Construction of SAH-based Bounding Volume Hierarchies": the surface area
/// heuristic over bins of centroids. The indices must have been checked. Throws Cancelled through
/// `progress`, which is given the triangles done, and Error for options out of range and meshes of 2^31
/// triangles or more.
///
/// A range that is too large for a leaf and has no split, for all its boxes have one centre, is halved by
/// index; so is one whose path would otherwise exceed `max_depth`. So the time is bounded by
/// max_depth * n, and on any but contrived meshes is n log n. Within a leaf, triangles keep the mesh's
/// order.
BinaryTree build_binned_sah(MeshView mesh, const BinnedSahOptions& options, Progress& progress);

/// The same over any items with boxes; the tree's order holds their indices. Call it in an arena, whose
/// threads it takes, under the default floating-point mode.
BinaryTree build_binned_sah(TriangleRefs items, const BinnedSahOptions& options, Progress& progress);

}  // namespace plumb::detail
