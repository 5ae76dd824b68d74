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
  /// Most references that spatial splits may add, as a share of the triangles, 0 to 1. A tree with any has
  /// triangles in several leaves, and boxes of what of its triangles is in them.
  float duplicates = 0;
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
///
/// With `duplicates` a range whose best halves would overlap is also tried with planes that cut triangles
/// (Stich, Friedrich and Dietrich 2009, "Spatial Splits in Bounding Volume Hierarchies"). The room for
/// references is shared out from the root down. Boxes then hold what check_tree says of References::Several.
/// Takes 64 bytes a triangle, and as many for each reference that there is room for, while it builds.
BinaryTree build_binned_sah(MeshView mesh, const BinnedSahOptions& options, Progress& progress);

/// The same over any items with boxes; the tree's order holds their indices, and nothing is split. Call it in
/// an arena, whose threads it takes, under the default floating-point mode.
BinaryTree build_binned_sah(TriangleRefs items, const BinnedSahOptions& options, Progress& progress);

}  // namespace plumb::detail
