#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "plumb/ray.h"
#include "plumb/simd.h"
#include "plumb/statistics.h"

namespace plumb {

namespace detail {
struct StructureData;
}

/// A scene made ready for rays, in whichever way: what Bvh, BruteForce and the others have in common.
///
/// Answers what docs/visibility.md defines, bit for bit, whichever structure it is (Arithmetic lists the
/// exceptions that can be asked for). Immutable: const calls from many threads are safe. Copies are cheap and
/// share the structure, so any of them can be kept as a Structure. One that was moved from can only be
/// assigned to.
class Structure {
 public:
  /// The smallest (t, id) among the hits that count, those with max(ray.tmin, 0) < t <= ray.tmax;
  /// {+inf, kNone} when there is none.
  Hit closest(const Ray& ray) const;
  /// Whether any hit counts.
  bool any(const Ray& ray) const;
  /// Replaces the contents of `hits` by every hit that counts, sorted by (t, id).
  void all(const Ray& ray, std::vector<Hit>& hits) const;
  /// The first hits of all(), as many as `hits` has room for, and how many these are; the rest of `hits`
  /// becomes {+inf, kNone}. Takes no memory, and does not look behind the last of them.
  std::size_t first(const Ray& ray, std::span<Hit> hits) const;

  /// The closest hit of every ray, hits[i] that of rays[i], on the calling thread. Throws plumb::Error
  /// when the sizes differ.
  ///
  /// Faster than ray by ray, for rays are traced together (exact trees of 4 and 8 children; Wald, Slusallek,
  /// Benthin and Wagner 2001, "Interactive Rendering with Coherent Ray Tracing"): best where neighbours in
  /// the span have about the same origin and direction, as pixels in squares of 4x4 have, and well where they
  /// start near each other. Hand over some hundred rays or more at once. The answers do not depend on it.
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  /// Whether any hit of each ray counts, in the same way.
  void any(std::span<const Ray> rays, std::span<bool> hits) const;

  /// What closest() tests for these rays, one by one. Slower than the answers.
  TestCounts count_tests(std::span<const Ray> rays) const;

  /// The same structure, shared, with its queries on another instruction set: Auto is the best one. One in
  /// plain scalar code stays so. Throws plumb::Error for one that is not among simd_targets().
  Structure with_simd(Simd simd) const;

  /// What the structure is like.
  Statistics statistics() const;

  /// For the library's own use.
  const detail::StructureData& data() const { return *data_; }

 protected:
  /// For those that make one.
  explicit Structure(std::shared_ptr<const detail::StructureData> data);

  std::shared_ptr<const detail::StructureData> data_;  ///< for those that can change what they hold
};

}  // namespace plumb
