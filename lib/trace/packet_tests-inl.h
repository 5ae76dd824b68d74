// A packet's rays against a box or a leaf's triangles, rays in lanes. Included once per Highway target.

#if defined(PLUMB_TRACE_PACKET_TESTS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_PACKET_TESTS_INL_H_
#undef PLUMB_TRACE_PACKET_TESTS_INL_H_
#else
#define PLUMB_TRACE_PACKET_TESTS_INL_H_
#endif

#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "exact/filter-inl.h"
#include "exact/intersect.h"
#include "hwy/highway.h"
#include "trace/box_ray.h"
#include "trace/packet.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <bool kStays, int W>
HWY_INLINE std::uint32_t MeetBoxIf(const PacketRays& packet, const PacketSlabs& slabs, const float* limit,
                                   const float* bounds) {
  const hn::CappedTag<float, kPacketRays> d;
  using V = hn::Vec<decltype(d)>;
  std::uint32_t met = 0;
  for (size_t i = 0; i < kPacketRays; i += hn::Lanes(d)) {
    V nearest = hn::Load(d, packet.tmin + i);
    V farthest = hn::Load(d, limit + i);
    for (int axis = 0; axis < 3; ++axis) {
      const V origin = hn::Load(d, packet.origin[axis] + i);
      const V near_plane = hn::Set(d, bounds[slabs.near_row[axis] * W]);
      const V far_plane = hn::Set(d, bounds[slabs.far_row[axis] * W]);
      if constexpr (kStays) {
        if (packet.stays[axis]) {
          const auto inside = hn::And(hn::Ge(origin, near_plane), hn::Le(origin, far_plane));
          farthest = hn::IfThenElse(inside, farthest, hn::Set(d, -1.0f));
          continue;
        }
      }
      const V to_near = hn::Sub(near_plane, origin);
      const V to_far = hn::Sub(far_plane, origin);
      nearest = hn::Max(nearest, hn::Mul(to_near, hn::Load(d, packet.inv_near[axis] + i)));
      farthest = hn::Min(farthest, hn::Mul(to_far, hn::Load(d, packet.inv_far[axis] + i)));
    }
    nearest = hn::Sub(nearest, hn::Set(d, PacketSlabs::kUnderflow));
    met |= MaskBits(d, hn::Le(nearest, farthest)) << i;
  }
  return met;
}

template <int W>
HWY_NOINLINE std::uint32_t MeetBoxStaying(const PacketRays& packet, const PacketSlabs& slabs,
                                          const float* limit, const float* bounds) {
  return MeetBoxIf<true, W>(packet, slabs, limit, bounds);
}

// The rays that may meet a box no farther than their limits, one bit each: BoxRay's test, which finds the
// same in a lane as it does for the ray alone; on an axis where the rays stay it is exact. `bounds` are a
// child's, a row of a node's bounds after the other.
template <int W>
HWY_INLINE std::uint32_t MeetBox(const PacketRays& packet, const PacketSlabs& slabs, const float* limit,
                                 const float* bounds) {
  return HWY_UNLIKELY(packet.any_stays) ? MeetBoxStaying<W>(packet, slabs, limit, bounds)
                                        : MeetBoxIf<false, W>(packet, slabs, limit, bounds);
}

// What the filter (exact/filter-inl.h) takes of the triangles of a block, and no ray changes, computed for
// all of them at once: e1, e2 and N, and the factors of the bounds.
template <int W>
struct alignas(64) LeafTerms {
  float e1[3][W], e2[3][W], n[3][W];
  float size_error[W];  // 7.2 u D L^2
  // Where all rays have one origin:
  float side1[3][W], side2[3][W];  // a x e1, a x e2
  float t_num[W];                  // N . a
  float along_error[W];            // 8.2 u R L^2 + 2^-120
  float edge_error[W];             // 9.3 u D L (2 R + L)
};

// Where all rays have one origin: the edge functions of lanes [i, i + Lanes(d)) for the centre of the
// packet's box of directions, and how far they get from it for any direction in the box.
//
// An edge function is then a linear function of the direction, E = s.d with s = a x e1, e2 x a and N less
// these two; over a box of directions c +- h it lies within s.c +- |s|.h. To the errors of a x e1 and a x e2
// (4 u R
// (|e_j| + |e_k|) a component) and of N (4 u (|e1_j e2_k| + |e1_k e2_j|)) come 3 u for the sums that make the
// third s, and 7 u for the dot products' six terms, which is less than
//     u D L (14 L + 28 R)
// for each end of each range, D the sum of the box's greatest magnitudes; box_scale has 16 u. What underflows
// is less than in FilterValues' account, with two more terms, far inside the slack.
template <int W, class D, class V = hn::Vec<D>>
HWY_INLINE void EdgeRanges(D d, const PacketRays& packet, const LeafTerms<W>& terms, size_t i, V& edge0,
                           V& edge1, V& edge2, V& spread0, V& spread1, V& spread2) {
  const auto load = [&](const float* from) HWY_ATTR { return hn::Load(d, from + i); };
  const auto range = [&](V x, V y, V z, V& edge, V& spread) HWY_ATTR {
    const auto dot = [&](V sx, V sy, V sz, const float* with) HWY_ATTR {
      return hn::MulAdd(sz, hn::Set(d, with[2]),
                        hn::MulAdd(sy, hn::Set(d, with[1]), hn::Mul(sx, hn::Set(d, with[0]))));
    };
    edge = dot(x, y, z, packet.centre);
    spread = dot(hn::Abs(x), hn::Abs(y), hn::Abs(z), packet.half);
  };
  const V side1x = load(terms.side1[0]), side1y = load(terms.side1[1]), side1z = load(terms.side1[2]);
  const V side2x = load(terms.side2[0]), side2y = load(terms.side2[1]), side2z = load(terms.side2[2]);
  range(side1x, side1y, side1z, edge0, spread0);
  range(hn::Neg(side2x), hn::Neg(side2y), hn::Neg(side2z), edge2, spread2);
  range(hn::Add(hn::Sub(load(terms.n[0]), side1x), side2x),
        hn::Add(hn::Sub(load(terms.n[1]), side1y), side2y),
        hn::Add(hn::Sub(load(terms.n[2]), side1z), side2z), edge1, spread1);
}

// Fills the terms. Returns the triangles that some ray may cover, one bit each: the others have an edge
// function that is below 0 for all rays and one that is above.
template <int W>
HWY_INLINE std::uint32_t MakeLeafTerms(const PacketRays& packet, const TriangleBlock<W>& block,
                                       LeafTerms<W>& terms) {
  const hn::CappedTag<float, W> d;
  using V = hn::Vec<decltype(d)>;
  std::uint32_t met = 0;
  for (size_t i = 0; i < static_cast<size_t>(W); i += hn::Lanes(d)) {
    const auto load = [&](int v, int axis) HWY_ATTR { return hn::Load(d, block.vertex[v][axis] + i); };
    const V v0x = load(0, 0), v0y = load(0, 1), v0z = load(0, 2);
    const V e1x = hn::Sub(load(1, 0), v0x), e1y = hn::Sub(load(1, 1), v0y), e1z = hn::Sub(load(1, 2), v0z);
    const V e2x = hn::Sub(load(2, 0), v0x), e2y = hn::Sub(load(2, 1), v0y), e2z = hn::Sub(load(2, 2), v0z);
    const V nx = hn::MulSub(e1y, e2z, hn::Mul(e1z, e2y));
    const V ny = hn::MulSub(e1z, e2x, hn::Mul(e1x, e2z));
    const V nz = hn::MulSub(e1x, e2y, hn::Mul(e1y, e2x));
    hn::Store(nx, d, terms.n[0] + i);
    hn::Store(ny, d, terms.n[1] + i);
    hn::Store(nz, d, terms.n[2] + i);
    const V extent = hn::Load(d, block.extent + i);
    const V extent2 = hn::Mul(extent, extent);
    hn::Store(hn::Mul(extent2, hn::Set(d, packet.den_scale)), d, terms.size_error + i);
    if (!packet.common_origin) {
      hn::Store(e1x, d, terms.e1[0] + i);
      hn::Store(e1y, d, terms.e1[1] + i);
      hn::Store(e1z, d, terms.e1[2] + i);
      hn::Store(e2x, d, terms.e2[0] + i);
      hn::Store(e2y, d, terms.e2[1] + i);
      hn::Store(e2z, d, terms.e2[2] + i);
      continue;
    }
    const V ax = hn::Sub(v0x, hn::Set(d, packet.origin[0][0]));
    const V ay = hn::Sub(v0y, hn::Set(d, packet.origin[1][0]));
    const V az = hn::Sub(v0z, hn::Set(d, packet.origin[2][0]));
    const V side1x = hn::MulSub(ay, e1z, hn::Mul(az, e1y));
    const V side1y = hn::MulSub(az, e1x, hn::Mul(ax, e1z));
    const V side1z = hn::MulSub(ax, e1y, hn::Mul(ay, e1x));
    const V side2x = hn::MulSub(ay, e2z, hn::Mul(az, e2y));
    const V side2y = hn::MulSub(az, e2x, hn::Mul(ax, e2z));
    const V side2z = hn::MulSub(ax, e2y, hn::Mul(ay, e2x));
    hn::Store(side1x, d, terms.side1[0] + i);
    hn::Store(side1y, d, terms.side1[1] + i);
    hn::Store(side1z, d, terms.side1[2] + i);
    hn::Store(side2x, d, terms.side2[0] + i);
    hn::Store(side2y, d, terms.side2[1] + i);
    hn::Store(side2z, d, terms.side2[2] + i);
    hn::Store(hn::MulAdd(nz, az, hn::MulAdd(ny, ay, hn::Mul(nx, ax))), d, terms.t_num + i);
    const V reach = hn::Max(hn::Abs(ax), hn::Max(hn::Abs(ay), hn::Abs(az)));
    hn::Store(hn::MulAdd(hn::Mul(reach, hn::Set(d, FilterRay::kDepthScale)), extent2, hn::Set(d, 0x1p-120f)),
              d, terms.along_error + i);
    const V size = hn::Mul(extent, hn::Add(hn::Add(reach, reach), extent));
    hn::Store(hn::Mul(size, hn::Set(d, packet.edge_scale)), d, terms.edge_error + i);
    V edge0, edge1, edge2, spread0, spread1, spread2;
    EdgeRanges(d, packet, terms, i, edge0, edge1, edge2, spread0, spread1, spread2);
    const V least_of_most =
        hn::Min(hn::Add(edge0, spread0), hn::Min(hn::Add(edge1, spread1), hn::Add(edge2, spread2)));
    const V most_of_least =
        hn::Max(hn::Sub(edge0, spread0), hn::Max(hn::Sub(edge1, spread1), hn::Sub(edge2, spread2)));
    const V error = hn::Mul(size, hn::Set(d, packet.box_scale));
    const auto missed = hn::And(hn::Lt(least_of_most, hn::Neg(error)), hn::Gt(most_of_least, error));
    met |= (MaskBits(d, hn::Not(missed)) & ((1u << hn::Lanes(d)) - 1u)) << i;
  }
  return packet.common_origin ? met : (1u << W) - 1u;
}

// FilterValues with rays in lanes, for triangle k of a block, and the bounds of the errors.
//
// With an origin of their own, rays go through the operations of FilterValues, and its bounds hold. With a
// common one, a x e1 and a x e2 are known, and E0 = d.(a x e1), E2 = -d.(a x e2). A component of a x e1
// is off by (1 for a, 1 for e1, 1 for the product, 1 for the difference) 4 u (|a_j e1_k| + |a_k e1_j|), the
// dot product adds 3, which makes at most
//     7 u sum |d_i| R (|e1_j| + |e1_k|) <= 7 u D R L,
// as the other way round. What underflows there is off by 2^-149 D + 2^-148 instead, and the slack,
// at least 0.29 * 2^-24 * D L^2 > 2^-86 D, is above 2^-116 as well.
template <int W, class D, class V = hn::Vec<D>>
HWY_INLINE void RayValues(D d, const PacketRays& packet, const TriangleBlock<W>& block,
                          const LeafTerms<W>& terms, size_t k, size_t i, V& edge0, V& edge1, V& edge2,
                          V& error, V& den, V& size_error, V& t_num, V& along_error) {
  const V dx = hn::Load(d, packet.direction[0] + i);
  const V dy = hn::Load(d, packet.direction[1] + i);
  const V dz = hn::Load(d, packet.direction[2] + i);
  const V nx = hn::Set(d, terms.n[0][k]), ny = hn::Set(d, terms.n[1][k]), nz = hn::Set(d, terms.n[2][k]);
  den = hn::MulAdd(nz, dz, hn::MulAdd(ny, dy, hn::Mul(nx, dx)));
  size_error = hn::Set(d, terms.size_error[k]);
  V edge2_negated;
  if (packet.common_origin) {
    edge0 =
        hn::MulAdd(hn::Set(d, terms.side1[2][k]), dz,
                   hn::MulAdd(hn::Set(d, terms.side1[1][k]), dy, hn::Mul(hn::Set(d, terms.side1[0][k]), dx)));
    edge2_negated =
        hn::MulAdd(hn::Set(d, terms.side2[2][k]), dz,
                   hn::MulAdd(hn::Set(d, terms.side2[1][k]), dy, hn::Mul(hn::Set(d, terms.side2[0][k]), dx)));
    t_num = hn::Set(d, terms.t_num[k]);
    along_error = hn::Set(d, terms.along_error[k]);
    error = hn::Set(d, terms.edge_error[k]);
  } else {
    const V ax = hn::Sub(hn::Set(d, block.vertex[0][0][k]), hn::Load(d, packet.origin[0] + i));
    const V ay = hn::Sub(hn::Set(d, block.vertex[0][1][k]), hn::Load(d, packet.origin[1] + i));
    const V az = hn::Sub(hn::Set(d, block.vertex[0][2][k]), hn::Load(d, packet.origin[2] + i));
    const V mx = hn::MulSub(dy, az, hn::Mul(dz, ay));
    const V my = hn::MulSub(dz, ax, hn::Mul(dx, az));
    const V mz = hn::MulSub(dx, ay, hn::Mul(dy, ax));
    edge0 = hn::MulAdd(hn::Set(d, terms.e1[2][k]), mz,
                       hn::MulAdd(hn::Set(d, terms.e1[1][k]), my, hn::Mul(hn::Set(d, terms.e1[0][k]), mx)));
    edge2_negated =
        hn::MulAdd(hn::Set(d, terms.e2[2][k]), mz,
                   hn::MulAdd(hn::Set(d, terms.e2[1][k]), my, hn::Mul(hn::Set(d, terms.e2[0][k]), mx)));
    t_num = hn::MulAdd(nz, az, hn::MulAdd(ny, ay, hn::Mul(nx, ax)));
    const V reach = hn::Max(hn::Abs(ax), hn::Max(hn::Abs(ay), hn::Abs(az)));
    const V extent = hn::Set(d, block.extent[k]);
    const V extent2 = hn::Mul(extent, extent);
    along_error =
        hn::MulAdd(hn::Mul(reach, hn::Set(d, FilterRay::kDepthScale)), extent2, hn::Set(d, 0x1p-120f));
    const V scaled = hn::Mul(extent, hn::Set(d, packet.edge_scale));
    error = hn::Mul(scaled, hn::Add(hn::Add(reach, reach), extent));
  }
  edge1 = hn::Add(hn::Sub(den, edge0), edge2_negated);
  edge2 = hn::Neg(edge2_negated);
}

// FilterTriangles with rays in lanes, for triangle k of a block.
template <int W, class D, class V = hn::Vec<D>>
HWY_INLINE void FilterRays(D d, const PacketRays& packet, const TriangleBlock<W>& block,
                           const LeafTerms<W>& terms, size_t k, size_t i, V limit, hn::Mask<D>& possible,
                           hn::Mask<D>& certain, V& along, V& along_error, V& size, V& size_error) {
  V edge0, edge1, edge2, error, den, t_num;
  RayValues(d, packet, block, terms, k, i, edge0, edge1, edge2, error, den, size_error, t_num, along_error);
  const V e_min = hn::Min(edge0, hn::Min(edge1, edge2));
  const V e_max = hn::Max(edge0, hn::Max(edge1, edge2));
  const V minus_error = hn::Neg(error);
  const auto missed = hn::And(hn::Lt(e_min, minus_error), hn::Gt(e_max, error));
  certain = hn::Or(hn::Gt(e_min, error), hn::Lt(e_max, minus_error));
  size = hn::Abs(den);
  along = hn::Xor(t_num, hn::And(hn::SignBit(d), den));
  const auto beyond = hn::Gt(hn::Sub(along, along_error), hn::Mul(limit, hn::Add(size, size_error)));
  const auto behind = hn::And(hn::Lt(along, hn::Neg(along_error)), hn::Gt(size, size_error));
  possible = hn::Not(hn::Or(missed, hn::Or(beyond, behind)));
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
