#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "plumb/mesh.h"
#include "plumb/ray.h"
#include "plumb/simd.h"

namespace plumb {

/// How much time a build takes for how fast a tree. With Arithmetic::Exact the answers are the same.
enum class Quality { Fast, Balanced, Best };

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
};

/// What a tree is like.
struct Statistics {
  std::size_t triangles = 0;         ///< in the mesh
  std::size_t unseen_triangles = 0;  ///< of these, left out: a coordinate is NaN or infinite
  std::size_t nodes = 0;             ///< inner nodes
  std::size_t leaves = 0;            ///< nodes that hold triangles
  int width = 0;                     ///< children per node
  int depth = 0;                     ///< nodes on the longest path from the root to a leaf
  double fill = 0;                   ///< used children, as a share of `nodes * width`
  double leaf_fill = 0;              ///< triangles in leaves, as a share of the lanes they take
  /// Boxes and triangles that a random line which meets the root's box is expected to be tested
  /// against, if nothing hides anything: the surface area heuristic (Goldsmith and Salmon 1987;
  /// MacDonald and Booth 1990). Each counts 1, whatever number a machine tests at once, so that trees
  /// of all widths compare.
  double sah_cost = 0;
  std::size_t bytes = 0;     ///< memory held, triangles included
  double build_seconds = 0;  ///< what the constructor took, by the wall clock
};

/// A bounding volume hierarchy over a copy of the mesh.
///
/// Answers what docs/visibility.md defines, bit for bit, whatever the width, the quality, the instruction
/// set and the caller's floating-point mode; less where a lesser Arithmetic was asked for. Immutable:
/// const calls from many threads are safe, and copies share the tree. One that was moved from can only be
/// assigned to.
///
/// Built by the surface area heuristic over bins (Wald 2007, "On fast Construction of SAH-based Bounding
/// Volume Hierarchies"), then collapsed to wide nodes (Wald, Benthin and Boulos 2008, "Getting Rid of
/// Packets"). Takes about n log n time for n triangles.
class Bvh {
 public:
  /// Copies what it needs of the mesh, which may have any number of triangles, none as well. Triangles
  /// with a NaN or infinite coordinate are left out, and counted in statistics().
  /// Throws plumb::Error for a vertex index out of range, ids that reach kNone, 2^31 triangles and
  /// more, and options out of range, and Cancelled when the options' progress says so.
  explicit Bvh(MeshView mesh, const BuildOptions& options = {});

  /// The smallest (t, id) among the hits that count, those with max(ray.tmin, 0) < t <= ray.tmax;
  /// {+inf, kNone} when there is none.
  Hit closest(const Ray& ray) const;
  /// Whether any hit counts.
  bool any(const Ray& ray) const;
  /// Replaces the contents of `hits` by every hit that counts, sorted by (t, id).
  void all(const Ray& ray, std::vector<Hit>& hits) const;

  /// The closest hit of every ray, hits[i] that of rays[i], on the calling thread. Throws plumb::Error
  /// when the sizes differ.
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// Whether any hit of each ray counts, in the same way.
  void any(std::span<const Ray> rays, std::span<bool> hits) const;

  /// The same tree, shared, with its queries on another instruction set: Auto is the best one. Throws
  /// plumb::Error for one that is not among simd_targets().
  Bvh with_simd(Simd simd) const;

  /// What the tree is like.
  Statistics statistics() const;

  struct Impl;

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace plumb
