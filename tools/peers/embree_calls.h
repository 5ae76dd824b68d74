#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

#include <embree3/rtcore.h>

#include "plumb/ray.h"

// plumb's rays through Embree's calls of each width. Putting rays into Embree's structures and taking
// the answers out is part of what is timed, as it is part of any program that uses it. Call them with
// FlushMode, as Embree's manual asks.

namespace plumb::peers {

inline void closest_one(RTCScene scene, RTCIntersectContext& context, const Ray& ray, Hit& hit) {
  RTCRayHit query;
  query.ray = {ray.origin.x,
               ray.origin.y,
               ray.origin.z,
               ray.tmin,
               ray.direction.x,
               ray.direction.y,
               ray.direction.z,
               0.0f,
               ray.tmax,
               ~0u,
               0,
               0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene, &context, &query);
  hit = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? Hit{} : Hit{query.ray.tfar, query.hit.primID};
}

inline void any_one(RTCScene scene, RTCIntersectContext& context, const Ray& ray, bool& hit) {
  RTCRay query = {ray.origin.x,
                  ray.origin.y,
                  ray.origin.z,
                  ray.tmin,
                  ray.direction.x,
                  ray.direction.y,
                  ray.direction.z,
                  0.0f,
                  ray.tmax,
                  ~0u,
                  0,
                  0};
  rtcOccluded1(scene, &context, &query);
  hit = query.tfar < 0.0f;
}

/// Embree's packet types and calls by their width.
template <int N>
struct Packet;

template <>
struct Packet<4> {
  using Rays = RTCRay4;
  using RayHits = RTCRayHit4;
  static void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context, RayHits* query) {
    rtcIntersect4(valid, scene, context, query);
  }
  static void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context, Rays* query) {
    rtcOccluded4(valid, scene, context, query);
  }
};

template <>
struct Packet<8> {
  using Rays = RTCRay8;
  using RayHits = RTCRayHit8;
  static void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context, RayHits* query) {
    rtcIntersect8(valid, scene, context, query);
  }
  static void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context, Rays* query) {
    rtcOccluded8(valid, scene, context, query);
  }
};

template <>
struct Packet<16> {
  using Rays = RTCRay16;
  using RayHits = RTCRayHit16;
  static void intersect(const int* valid, RTCScene scene, RTCIntersectContext* context, RayHits* query) {
    rtcIntersect16(valid, scene, context, query);
  }
  static void occluded(const int* valid, RTCScene scene, RTCIntersectContext* context, Rays* query) {
    rtcOccluded16(valid, scene, context, query);
  }
};

/// Fills a packet's first lanes; the others are switched off and hold a harmless ray.
template <int N>
void fill(std::span<const Ray> rays, int* valid, typename Packet<N>::Rays& packet) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(N); ++i) {
    const bool used = i < rays.size();
    const Ray& ray = rays[used ? i : 0];
    valid[i] = used ? -1 : 0;
    packet.org_x[i] = ray.origin.x;
    packet.org_y[i] = ray.origin.y;
    packet.org_z[i] = ray.origin.z;
    packet.tnear[i] = ray.tmin;
    packet.dir_x[i] = ray.direction.x;
    packet.dir_y[i] = ray.direction.y;
    packet.dir_z[i] = ray.direction.z;
    packet.time[i] = 0.0f;
    packet.tfar[i] = ray.tmax;
    packet.mask[i] = ~0u;
    packet.id[i] = 0;
    packet.flags[i] = 0;
  }
}

template <int N>
void closest_packet(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays, Hit* hits) {
  alignas(64) int valid[N];
  alignas(64) typename Packet<N>::RayHits query;
  fill<N>(rays, valid, query.ray);
  std::fill_n(query.hit.geomID, N, RTC_INVALID_GEOMETRY_ID);
  Packet<N>::intersect(valid, scene, &context, &query);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const bool missed = query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID;
    hits[i] = missed ? Hit{} : Hit{query.ray.tfar[i], query.hit.primID[i]};
  }
}

template <int N>
void any_packet(RTCScene scene, RTCIntersectContext& context, std::span<const Ray> rays, bool* hits) {
  alignas(64) int valid[N];
  alignas(64) typename Packet<N>::Rays query;
  fill<N>(rays, valid, query);
  Packet<N>::occluded(valid, scene, &context, &query);
  for (std::size_t i = 0; i < rays.size(); ++i) hits[i] = query.tfar[i] < 0.0f;
}

}  // namespace plumb::peers
