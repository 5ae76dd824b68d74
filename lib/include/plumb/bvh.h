#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// How much time a build takes for how fast a tree. With Arithmetic::Exact the answers are the same.
enum class Quality {
  /// Treelets of up to 64 triangles are cut from their order along a Morton curve, and the surface area
  /// heuristic makes a tree over them (Pantaleoni and Luebke 2010, "HLBVH"): for scenes that change every
  /// frame. Takes about 0.4 of the time of Balanced, and while it builds some 60 bytes a triangle beside
  /// the tree; rays are 0.8 to 0.9 times as fast, less where triangles are long and thin.
  Fast,
  /// The surface area heuristic with bins (Wald 2007, "On fast Construction of SAH-based Bounding Volume
  /// Hierarchies"), then large nodes are put where they fit best (Meister and Bittner 2018, "Parallel
  /// Reinsertion for Bounding Volume Hierarchy Optimization"). While it builds it takes about 90 bytes a
  /// triangle beside the tree.
  Balanced,
  /// The same, with planes that cut triangles where boxes would overlap (Stich, Friedrich and Dietrich 2009,
  /// "Spatial Splits in Bounding Volume Hierarchies"): for scenes that stay. Takes three to five times as
  /// long as Balanced. It may add half as many references as there are triangles, and takes up to 1.5 times
  /// the memory for that; 2 percent are added in a scan, 15 in a building.
  Best,
};

/// How a ray is tested against boxes and triangles. Trees, their layouts and the traversal are the same for
/// all three. Each returns the same bits on every instruction set.
enum class Arithmetic {
  /// Plain float, as most ray tracers: Moeller and Trumbore 1997, "Fast, Minimum Storage Ray-Triangle
  /// Intersection". Promises nothing: at edges and vertices a ray may slip through a closed surface or
  /// hit two triangles, a box and all in it may be lost, `t` carries the rounding of every step, and of
  /// surfaces close together the wrong one may win. Such a ray's answer may depend on the tree, and its
  /// closest hit need not be the first of all.
  Fast,
  /// Float without cracks: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection". A ray from
  /// inside a closed surface hits it, if it starts farther from it than coordinates are rounded, however
  /// exactly it aims at an edge or a vertex. There it may hit more than one triangle. `t` is as inexact
  /// as in Fast, and near ties are decided as in Fast; a triangle that the ray passes by at less than the
  /// rounding may count as hit.
  Watertight,
  /// What docs/visibility.md defines, bit for bit.
  Exact,
};

/// How a Bvh is built and queried.
struct BuildOptions {
  /// Build time against ray speed.
  Quality quality = Quality::Balanced;
  /// Children per node: 2 (plain scalar code, the reference), 4 or 8; 0 picks the best for `simd`. Only
  /// 8 for arithmetics other than Exact.
  int width = 0;
  /// Threads for the build; 0 takes all that the affinity mask allows, and more are never used.
  /// The tree does not depend on it.
  int threads = 0;
  /// What the queries promise.
  Arithmetic arithmetic = Arithmetic::Exact;
  /// Instruction set of the queries; must be Auto or one of simd_targets(). Width 2 is scalar whatever it
  /// says.
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene. All ids must be
  /// below kNone.
  std::uint32_t first_id = 0;
  /// Called now and then with the share done, rising from 0 to 1, from whichever thread gets there but
  /// never from two at once. Returning false cancels: the constructor throws Cancelled. What it throws
  /// itself ends the build too and comes out of the constructor.
  std::function<bool(double)> progress = nullptr;
  /// Keeps each vertex of a leaf once: about 0.6 of the memory, and rays some percent slower, or faster where
  /// the tree does not fit the caches. Only for width 8 (or 0) and Arithmetic::Exact. The build takes
  /// longer, and as much memory for a while as without.
  bool compact = false;
};

/// What Bvh::refit() made of the tree.
struct RefitReport {
  /// How many more boxes a ray is expected to meet for each triangle that it comes by than in the tree as it
  /// was built (by the surface area heuristic, but against the triangles' own boxes instead of the scene's,
  /// so that moving or scaling all of it changes nothing): 1 is as good, 2 about half as fast.
  double looseness = 1.0;
  /// Whether it has become so loose, 1.5, that a new build, of Quality::Fast if need be, is soon paid back.
  bool rebuild_advised = false;
};

/// A bounding volume hierarchy over a copy of the mesh.
///
/// Built as Quality says, then collapsed to wide nodes (Wald, Benthin and Boulos 2008, "Getting Rid of
/// Packets"). Takes about n log n time for n triangles.
///
/// Copies what it needs of the mesh, which may have any number of triangles, none as well. Triangles with a
/// NaN or infinite coordinate are left out, and counted in statistics(). The answers do not depend on the
/// width or the quality.
class Bvh : public Structure {
 public:
  /// Throws plumb::Error for a vertex index out of range, ids that reach kNone, 2^31 triangles and
  /// more, and options out of range, and Cancelled when the options' progress says so.
  explicit Bvh(MeshView mesh, const BuildOptions& options = {});

  /// Follows vertices that moved: takes all coordinates anew, and makes the boxes fit without changing
  /// which triangles lie in which (Wald, Boulos and Shirley 2007, "Ray Tracing Deformable Scenes Using
  /// Dynamic Bounding Volume Hierarchies"). The answers are those of a new Bvh over `mesh`, bit for bit; only
  /// speed suffers, and the report tells how much. A tree of Quality::Best loses its spatial splits.
  ///
  /// `mesh` is the mesh as it is now, with as many triangles as before, in the same order; ids stay.
  /// `threads` is as in BuildOptions. Copies of this Bvh keep what they had: while there are some, the tree
  /// is copied first. No other thread may use this object meanwhile.
  ///
  /// Throws plumb::Error, and changes nothing, when the number of triangles differs, a vertex index is out of
  /// range, a triangle has become finite that was left out when the tree was built, or the tree is of width 2
  /// or compact.
  RefitReport refit(MeshView mesh, int threads = 0);

  /// As Structure::with_simd.
  Bvh with_simd(Simd simd) const { return Bvh(Structure::with_simd(simd)); }

 private:
  explicit Bvh(Structure structure) : Structure(std::move(structure)) {}
};

}  // namespace plumb
