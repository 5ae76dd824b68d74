#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/aligned.h"
#include "base/float4.h"
#include "build/binary_tree.h"
#include "plumb/mesh.h"

// What the builders sort instead of triangles: boxes of 32 bytes, moved as a whole so that every pass
// reads memory in order.

namespace plumb::detail {

/// A box in registers: lanes x, y, z, and a fourth that means nothing. Starts empty.
struct Box4 {
  Float4 lo = splat(std::numeric_limits<float>::infinity());
  Float4 hi = splat(-std::numeric_limits<float>::infinity());

  /// NaNs are left out.
  void add(Float4 other_lo, Float4 other_hi) {
    lo = min(other_lo, lo);
    hi = max(other_hi, hi);
  }
  void add(const Box4& other) { add(other.lo, other.hi); }
  Box box() const { return {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}}; }
};

/// A triangle's box and index. The box takes lanes 0 to 2; lane 3 of each half holds 16 bits of the
/// index as a float in [1, 2). As it stands an index would often be a subnormal number, and arithmetic
/// on the vectors would take its slow path for a lane that nobody reads.
struct alignas(32) TriangleRef {
  Float4 lo;
  Float4 hi;

  void set_index(std::uint32_t index) {
    lo[3] = std::bit_cast<float>(kOne | (index & 0xffffu));
    hi[3] = std::bit_cast<float>(kOne | (index >> 16));
  }
  std::uint32_t index() const {
    return (std::bit_cast<std::uint32_t>(lo[3]) & 0xffffu) | std::bit_cast<std::uint32_t>(hi[3]) << 16;
  }

 private:
  static constexpr std::uint32_t kOne = 0x3f800000u;
};
static_assert(sizeof(TriangleRef) == 32);

/// All finite triangles of a mesh, in its order.
///
/// Builders compare areas and distances in units that depend on the scene: coordinates times `unit`, a
/// power of two that brings the greatest of them below 4 and, where floats reach, above 1/2. Then
/// nothing overflows, and what underflows is very small against the scene. The boxes themselves stay as
/// they are. Zeros in them are positive, so that no box depends on the order of its triangles.
struct TriangleRefs {
  LargeArray<TriangleRef> refs;
  std::size_t count = 0;
  std::uint32_t unseen = 0;
  float unit = 1.0f;
  Box4 box;
};

/// Call it in an arena (base/parallel.h). The indices must have been checked.
TriangleRefs make_triangle_refs(MeshView mesh);

/// Twice the centre of a triangle's box, in the scene's unit.
inline Float4 doubled_centre(const TriangleRef& ref, Float4 unit) { return ref.lo * unit + ref.hi * unit; }

}  // namespace plumb::detail
