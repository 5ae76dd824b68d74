#include "build/triangle_refs.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "build/chunks.h"

namespace plumb::detail {
namespace {

constexpr std::size_t kPieceSize = 16384;

struct Piece {
  std::size_t finite = 0;
  Box4 box;
};

// Writes the finite triangles among [begin, end) to `out`, packed.
Piece make_piece(MeshView mesh, std::size_t begin, std::size_t end, TriangleRef* out) {
  Piece piece;
  const auto corner = [&](std::uint32_t index) {
    const glm::vec3& p = mesh.positions[index];
    return Float4{p.x, p.y, p.z, 0.0f};
  };
  for (std::size_t i = begin; i < end; ++i) {
    const glm::uvec3& corners = mesh.triangles[i];
    const Float4 a = corner(corners.x);
    const Float4 b = corner(corners.y);
    const Float4 c = corner(corners.z);
    const Float4 zero = ((a - a) + (b - b)) + (c - c);  // NaN where a coordinate is infinite or NaN
    if (!(zero[0] == 0.0f && zero[1] == 0.0f && zero[2] == 0.0f)) continue;
    const Float4 no_negative_zero = splat(0.0f);
    TriangleRef& ref = out[piece.finite++];
    ref.lo = min(a, min(b, c)) + no_negative_zero;
    ref.hi = max(a, max(b, c)) + no_negative_zero;
    piece.box.add(ref.lo, ref.hi);
    ref.set_index(static_cast<std::uint32_t>(i));
  }
  return piece;
}

// The power of two of TriangleRefs::unit. Its exponent is kept where neither it nor its inverse is
// subnormal.
float unit_of(const Box4& box) {
  float greatest = 0.0f;
  for (int axis = 0; axis < 3; ++axis) {
    greatest = std::max({greatest, std::fabs(box.lo[axis]), std::fabs(box.hi[axis])});
  }
  int exponent = 0;
  std::frexp(greatest, &exponent);
  return std::ldexp(1.0f, -std::clamp(exponent, -126, 126));
}

}  // namespace

TriangleRefs make_triangle_refs(MeshView mesh) {
  const std::size_t count = mesh.triangles.size();
  TriangleRefs result;
  result.refs = make_large_array<TriangleRef>(count);
  const std::size_t pieces = piece_count(count, kPieceSize);
  std::vector<Piece> piece(pieces);
  for_pieces(count, pieces, [&](std::size_t i, std::size_t begin, std::size_t end) {
    piece[i] = make_piece(mesh, begin, end, result.refs.get() + begin);
  });
  // Close the gaps that triangles left out have made.
  for (std::size_t i = 0; i < pieces; ++i) {
    TriangleRef* const from = result.refs.get() + piece_begin(count, pieces, i);
    TriangleRef* const to = result.refs.get() + result.count;
    if (from != to) std::copy(from, from + piece[i].finite, to);
    result.count += piece[i].finite;
    result.box.add(piece[i].box);
  }
  result.unseen = static_cast<std::uint32_t>(count - result.count);
  if (result.count != 0) result.unit = unit_of(result.box);
  return result;
}

}  // namespace plumb::detail
