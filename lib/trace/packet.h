#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "exact/intersect.h"
#include "plumb/ray.h"
#include "trace/query.h"

// A packet: rays that go the same way from about the same place, traced together, and what each of them has
// met so far. All of it is arrays with a place for each ray, which kernels take by the vector.

namespace plumb::detail {

/// Rays of a packet: as many floats as the widest registers hold.
inline constexpr std::size_t kPacketRays = 16;

/// The rays themselves, each within BoxRay's and FilterRay's range. Places that no ray fills repeat the first
/// one's.
struct alignas(64) PacketRays {
  float origin[3][kPacketRays];
  float direction[3][kPacketRays];
  float inv_near[3][kPacketRays];  ///< as BoxRay's
  float inv_far[3][kPacketRays];
  float tmin[kPacketRays];  ///< max(tmin, 0)
  float tmax[kPacketRays];
  /// Of t, at first: negative where there is no ray, or none that can hit anything.
  float limit[kPacketRays];
  const Ray* rays;                   ///< a span's
  std::uint32_t index[kPacketRays];  ///< which of them
  std::size_t count;
  bool any_stays;
  bool stays[3];       ///< on an axis where all directions are 0; a direction that is 0 among others makes no
                       ///< packet
  bool common_origin;  ///< all origins are equal
  /// FilterRay's, of the longest direction; bounds only grow with it.
  float edge_scale, den_scale;
  /// Where the origin is common: every direction lies in this box, its centre give or take.
  float centre[3], half[3];
  float box_scale;  ///< 16 u times the sum of the box's greatest magnitudes (PacketMeets)

  const Ray& ray(std::size_t i) const { return rays[index[i]]; }
};

/// All rays of a packet against boxes: BoxRay's test with the ends of what its rays hold, so that its near
/// value is no ray's greater and its far value no ray's less. For rounding is monotonic: the origin nearest
/// to the plane and the least inverse give the least near value, or where a ray has the plane behind it
/// a negative one, which the comparison with tmin >= 0 forgets; and far values the other way round.
struct PacketSlabs {
  float origin_near[3], origin_far[3];
  float inv_near[3], inv_far[3];
  std::uint32_t near_row[3], far_row[3];  ///< rows of WideNode::bounds, the same for all rays
  float tmin;                             ///< the least

  static constexpr float kUnderflow = 0x1p-120f;  ///< as BoxRay's

  float near_origin(int axis) const { return origin_near[axis]; }
  float far_origin(int axis) const { return origin_far[axis]; }
  float near_inverse(int axis) const { return inv_near[axis]; }
  float far_inverse(int axis) const { return inv_far[axis]; }
};

/// The smallest (t, id) of each ray, found as ClosestQuery finds it: a triangle that waits has only bounds of
/// its t, and exact depths are computed where bounds overlap.
struct alignas(64) ClosestPacket {
  static constexpr bool kOrdered = true;
  static constexpr bool kAnyHit = false;

  float limit[kPacketRays];          ///< no exact t above it matters; negative where no ray is
  float low[kPacketRays];            ///< of the triangle that waits; infinite where there is none
  float high[kPacketRays];           ///< likewise
  std::uint32_t block[kPacketRays];  ///< where it is
  std::uint32_t lane[kPacketRays];
  float best_t[kPacketRays];  ///< of those whose depth is known
  std::uint32_t best_id[kPacketRays];

  explicit ClosestPacket(const PacketRays& packet) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < kPacketRays; ++i) {
      limit[i] = packet.limit[i];
      low[i] = high[i] = best_t[i] = kInfinity;
      best_id[i] = kNone;
    }
  }

  /// Takes a line's hit.
  void take(const PacketRays& packet, std::size_t ray, float t, std::uint32_t id) {
    if (!depth_counts(packet.ray(ray), t) || !hit_before(t, id, {best_t[ray], best_id[ray]})) return;
    best_t[ray] = t;
    best_id[ray] = id;
    limit[ray] = std::min(limit[ray], depth_limit(t));
    if (t < low[ray]) low[ray] = high[ray] = std::numeric_limits<float>::infinity();  // farther for certain
  }
};

/// Whether any hit counts, for each ray. A ray that has one needs no more.
struct alignas(64) AnyPacket {
  static constexpr bool kOrdered = false;
  static constexpr bool kAnyHit = true;

  float limit[kPacketRays];  ///< as ClosestPacket's; negative as well where the answer is known
  std::uint32_t hit = 0;     ///< a bit for each ray

  explicit AnyPacket(const PacketRays& packet) { std::copy_n(packet.limit, kPacketRays, limit); }

  void take(const PacketRays& packet, std::size_t ray, float t, std::uint32_t) {
    if (depth_counts(packet.ray(ray), t)) close(ray);
  }
  void close(std::size_t ray) {
    hit |= 1u << ray;
    limit[ray] = -1.0f;
  }
};

}  // namespace plumb::detail
