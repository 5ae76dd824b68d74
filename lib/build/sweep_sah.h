#pragma once

#include "base/parallel.h"
#include "build/binary_tree.h"
#include "build/sah_rules.h"
#include "plumb/mesh.h"

namespace plumb::detail {

struct SweepSahOptions : SahOptions {};

/// The surface area heuristic over every place where a sorted list of the triangles can be cut, on each
/// axis, as in MacDonald and Booth 1990, "Heuristics for ray tracing using space subdivision", for
/// boxes: what binning approximates, and the reference for it. One thread; the sorting is done once
/// (Wald and Havran 2006, "On building fast kd-Trees for Ray Tracing, and on doing that in O(N log N)",
/// do it for kd-trees), so that a level of the tree takes linear time.
///
/// Invariants, errors, leaves and the limit of depth are those of build_binned_sah; where a path would
/// exceed it, a range is halved along its longest axis. Boxes with one centre are cut in the mesh's
/// order.
BinaryTree build_sweep_sah(MeshView mesh, const SweepSahOptions& options, Progress& progress);

}  // namespace plumb::detail
