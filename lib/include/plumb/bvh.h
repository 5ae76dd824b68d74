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

struct BuildOptions {
  /// Children per node: 2 (plain scalar code, the reference), 4 or 8; 0 picks the best for `simd`.
  int width = 0;
  /// Threads for the build; 0 takes all that the affinity mask allows. The tree does not depend on it.
  int threads = 0;
  /// Instruction set of the queries. plumb::Error if this machine cannot run it.
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene.
  std::uint32_t first_id = 0;
  /// Called now and then with the share done, 0 to 1, from the calling thread's build or one of its
  /// workers, never from two at once. Returning false cancels: the constructor throws Cancelled.
  std::function<bool(double)> progress;
};

/// What a tree is like.
struct Statistics {
  std::size_t triangles = 0;         ///< in the mesh
  std::size_t unseen_triangles = 0;  ///< of these, left out: a coordinate is NaN or infinite
  std::size_t nodes = 0;             ///< inner nodes
  std::size_t leaves = 0;
  int width = 0;          ///< children per node
  int depth = 0;          ///< nodes on the longest path from the root to a leaf
  double fill = 0;        ///< used children, as a share of `nodes * width`
  double leaf_fill = 0;   ///< triangles in leaves, as a share of the lanes they take
  double sah_cost = 0;    ///< expected boxes and triangles tested by a random ray that meets the root box
  std::size_t bytes = 0;  ///< memory held
  double build_seconds = 0;
};

/// A bounding volume hierarchy over a copy of the mesh. Answers what docs/visibility.md defines, bit
/// for bit, whatever the width and instruction set. Immutable: const calls from many threads are
/// safe, and copies share the tree.
class Bvh {
 public:
  /// Throws plumb::Error for an index out of range, too many triangles (ids stay below kNone), an
  /// unknown width or an instruction set that this machine lacks.
  explicit Bvh(MeshView mesh, const BuildOptions& options = {});

  /// The smallest (t, id) among the hits that count; {+inf, kNone} when there is none.
  Hit closest(const Ray& ray) const;
  /// Whether any hit counts.
  bool any(const Ray& ray) const;
  /// Replaces the contents of `hits` by every hit that counts, sorted by (t, id).
  void all(const Ray& ray, std::vector<Hit>& hits) const;

  /// The same for many rays, on the calling thread. Throws plumb::Error when the sizes differ.
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  void any(std::span<const Ray> rays, std::span<bool> hits) const;

  Statistics statistics() const;

  struct Impl;

 private:
  std::shared_ptr<const Impl> impl_;
};

}  // namespace plumb
