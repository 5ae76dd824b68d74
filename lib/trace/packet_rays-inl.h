// Which rays make a packet, and making it. Included once per Highway target.

#if defined(PLUMB_TRACE_PACKET_RAYS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_PACKET_RAYS_INL_H_
#undef PLUMB_TRACE_PACKET_RAYS_INL_H_
#else
#define PLUMB_TRACE_PACKET_RAYS_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#include "base/mask_bits-inl.h"
#include "exact/filter_ray.h"
#include "hwy/highway.h"
#include "trace/box_ray.h"
#include "trace/packet.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// One lane at a time there is nothing to gain, and no ConcatEven.
#if HWY_TARGET != HWY_SCALAR

namespace hn = hwy::HWY_NAMESPACE;

inline constexpr std::uint32_t kWholePacket = (1u << kPacketRays) - 1u;

// The rays of a packet that go backward along each axis, one bit each.
struct PacketSigns {
  std::uint32_t backward[3];

  bool one_octant() const {
    const auto same = [](std::uint32_t bits) { return bits == 0 || bits == kWholePacket; };
    return same(backward[0]) && same(backward[1]) && same(backward[2]);
  }
  // The octant of ray i, below 8.
  std::uint32_t octant(std::uint32_t i) const {
    return (backward[0] >> i & 1u) | (backward[1] >> i & 1u) << 1 | (backward[2] >> i & 1u) << 2;
  }
};

// Copies the `count` rays that packet.index names, and the first of them to the places that are left.
HWY_INLINE PacketSigns LoadRays(const Ray* rays, size_t count, PacketRays& packet) {
  packet.rays = rays;
  packet.count = count;
  // Two floats of a ray to a number, four numbers to a ray.
  static_assert(sizeof(Ray) == 4 * sizeof(std::uint64_t));
  alignas(64) std::uint64_t pairs[4 * kPacketRays];
  for (size_t i = 0; i < kPacketRays; ++i) {
    std::memcpy(pairs + 4 * i, &rays[packet.index[i < count ? i : 0]], sizeof(Ray));
  }
  const hn::CappedTag<float, kPacketRays> d;
  const hn::Repartition<std::uint64_t, decltype(d)> d64;
  PacketSigns signs{};
  for (size_t i = 0; i < kPacketRays; i += hn::Lanes(d)) {
    // Not in arrays: an SVE vector has no size.
    hn::Vec<decltype(d64)> low0, low1, low2, low3, high0, high1, high2, high3;
    hn::LoadInterleaved4(d64, pairs + 4 * i, low0, low1, low2, low3);
    hn::LoadInterleaved4(d64, pairs + 4 * (i + hn::Lanes(d64)), high0, high1, high2, high3);
    const auto store = [&](auto low, auto high, float* first, float* second) HWY_ATTR {
      hn::Store(hn::ConcatEven(d, hn::BitCast(d, high), hn::BitCast(d, low)), d, first + i);
      hn::Store(hn::ConcatOdd(d, hn::BitCast(d, high), hn::BitCast(d, low)), d, second + i);
    };
    store(low0, high0, packet.origin[0], packet.origin[1]);
    store(low1, high1, packet.origin[2], packet.tmin);
    store(low2, high2, packet.direction[0], packet.direction[1]);
    store(low3, high3, packet.direction[2], packet.tmax);
    for (int axis = 0; axis < 3; ++axis) {
      const auto direction = hn::Load(d, packet.direction[axis] + i);
      signs.backward[axis] |= MaskBits(d, hn::Lt(direction, hn::Zero(d))) << i;
    }
  }
  return signs;
}

// The least and the greatest of a packet's numbers.
struct LaneEnds {
  float least, most;
};

HWY_INLINE LaneEnds EndsOf(const float* values) {
  const hn::CappedTag<float, kPacketRays> d;
  auto least = hn::Load(d, values), most = least;
  for (size_t i = hn::Lanes(d); i < kPacketRays; i += hn::Lanes(d)) {
    const auto value = hn::Load(d, values + i);
    least = hn::Min(least, value);
    most = hn::Max(most, value);
  }
  return {hn::GetLane(hn::MinOfLanes(d, least)), hn::GetLane(hn::MaxOfLanes(d, most))};
}

// Fills tmin, limit, inverses and scales of loaded rays; false where the analysis of the float tests does not
// hold for some ray (BoxRay::in_range, FilterRay).
HWY_INLINE bool PrepareRays(PacketRays& packet) {
  const hn::CappedTag<float, kPacketRays> d;
  using V = hn::Vec<decltype(d)>;
  const hn::RebindToUnsigned<decltype(d)> du;
  const V zero = hn::Zero(d);
  const V infinity = hn::Set(d, std::numeric_limits<float>::infinity());
  V longest = zero;
  auto usable = hn::Eq(zero, zero);
  auto common = usable;
  std::uint32_t zeros[3] = {};
  for (size_t i = 0; i < kPacketRays; i += hn::Lanes(d)) {
    const V given_tmin = hn::Load(d, packet.tmin + i);
    const V tmin = hn::IfThenElse(hn::Gt(given_tmin, zero), given_tmin, zero);
    usable = hn::And(usable, hn::Eq(given_tmin, given_tmin));
    hn::Store(tmin, d, packet.tmin + i);
    // depth_limit(tmax), or -1 where no t counts.
    const V tmax = hn::Load(d, packet.tmax + i);
    const V next = hn::BitCast(d, hn::Add(hn::BitCast(du, tmax), hn::Set(du, 1)));
    const V limit = hn::IfThenElse(hn::Lt(tmax, infinity), next, tmax);
    hn::Store(hn::IfThenElse(hn::Lt(tmin, tmax), limit, hn::Set(d, -1.0f)), d, packet.limit + i);
    V length = zero;
    for (int axis = 0; axis < 3; ++axis) {
      const V direction = hn::Load(d, packet.direction[axis] + i);
      const V origin = hn::Load(d, packet.origin[axis] + i);
      const V magnitude = hn::Abs(direction);
      // False for NaN and infinities.
      const auto stays = hn::Eq(direction, zero);
      zeros[axis] |= MaskBits(d, stays) << i;
      usable = hn::And(usable,
                       hn::And(hn::Lt(hn::Abs(origin), hn::Set(d, FilterRay::kPlainCoordinate)),
                               hn::And(hn::Or(hn::Gt(magnitude, hn::Set(d, 0x1p-60f)), stays),
                                       hn::Lt(magnitude, hn::Set(d, 0.25f * FilterRay::kPlainDirection)))));
      common = hn::And(common, hn::Eq(origin, hn::Set(d, packet.origin[axis][0])));
      length = hn::Add(length, magnitude);
      const V inverse = hn::Div(hn::Set(d, 1.0f), direction);
      hn::Store(hn::Mul(inverse, hn::Set(d, BoxRay::kNearFactor)), d, packet.inv_near[axis] + i);
      hn::Store(hn::Mul(inverse, hn::Set(d, BoxRay::kFarFactor)), d, packet.inv_far[axis] + i);
    }
    longest = hn::Max(longest, length);
  }
  for (size_t i = packet.count; i < kPacketRays; ++i) packet.limit[i] = -1.0f;
  const float d_norm = std::max(hn::GetLane(hn::MaxOfLanes(d, longest)), FilterRay::kLeastDirection);
  packet.edge_scale = FilterRay::kEdgeScale * d_norm;
  packet.den_scale = FilterRay::kDenScale * d_norm;
  packet.common_origin = hn::AllTrue(d, common);
  for (int axis = 0; axis < 3; ++axis) {
    packet.stays[axis] = zeros[axis] == kWholePacket;
    if (zeros[axis] != 0 && !packet.stays[axis]) return false;
  }
  packet.any_stays = packet.stays[0] || packet.stays[1] || packet.stays[2];
  if (packet.stays[0] && packet.stays[1] && packet.stays[2]) return false;  // no direction
  return hn::AllTrue(d, usable);
}

// Makes a packet of loaded rays of one octant; false where PrepareRays() is, or the scene is out of range.
HWY_INLINE bool MakePacket(float greatest, PacketRays& packet, PacketSlabs& slabs) {
  if (!PrepareRays(packet) || !(greatest < FilterRay::kPlainCoordinate)) return false;
  slabs.tmin = EndsOf(packet.tmin).least;
  float box_norm = 0.0f;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const bool forward = packet.direction[axis][0] >= 0.0f;
    slabs.near_row[axis] = 2 * axis + (forward ? 0 : 1);
    slabs.far_row[axis] = 2 * axis + (forward ? 1 : 0);
    // All operations round monotonically, so the longest direction has the inverse nearest to 0.
    const LaneEnds direction = EndsOf(packet.direction[axis]);
    const float longest_inverse = 1.0f / (forward ? direction.most : direction.least);
    const float shortest_inverse = 1.0f / (forward ? direction.least : direction.most);
    slabs.inv_near[axis] = longest_inverse * BoxRay::kNearFactor;
    slabs.inv_far[axis] = shortest_inverse * BoxRay::kFarFactor;
    if (packet.common_origin) {
      slabs.origin_near[axis] = slabs.origin_far[axis] = packet.origin[axis][0];
      // The centre is off by a unit in its last place, the half by less.
      packet.centre[axis] = 0.5f * (direction.least + direction.most);
      packet.half[axis] =
          0.5f * (direction.most - direction.least) + std::fabs(packet.centre[axis]) * 0x1p-22f;
      box_norm += std::fabs(packet.centre[axis]) + packet.half[axis];
    } else {
      const LaneEnds origin = EndsOf(packet.origin[axis]);
      slabs.origin_near[axis] = forward ? origin.most : origin.least;
      slabs.origin_far[axis] = forward ? origin.least : origin.most;
    }
    if (packet.stays[axis]) {
      // As StayingBoxRay has it.
      constexpr float kInfinity = std::numeric_limits<float>::infinity();
      slabs.origin_near[axis] = std::nextafter(slabs.origin_near[axis], kInfinity);
      slabs.origin_far[axis] = std::nextafter(slabs.origin_far[axis], -kInfinity);
      slabs.inv_near[axis] = slabs.inv_far[axis] = kInfinity;
    }
  }
  packet.box_scale = 16.0f * 0x1p-24f * std::max(box_norm, FilterRay::kLeastDirection);
  return true;
}

#endif

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
