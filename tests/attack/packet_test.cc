// Attacks what packets of rays are tested by (trace/packet_tests-inl.h, trace/packet_rays-inl.h): a search
// for rays and triangles whose computed values, or the ranges over all of a packet's directions, are as far
// off as possible; and boxes, where what stands for all rays must not be stricter than one of them. Each
// Highway target by itself.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/packet_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "trace/box_ray.h"
#include "trace/box_test-inl.h"
#include "trace/packet_rays-inl.h"
#include "trace/packet_tests-inl.h"

#ifndef PLUMB_TESTS_ATTACK_PACKET_VALUES
#define PLUMB_TESTS_ATTACK_PACKET_VALUES
namespace plumb::detail {

// Of a packet and the triangle in lane 0 of a block.
struct PacketValues {
  bool made = false;
  bool common_origin = false;
  float edge[3][kPacketRays], den[kPacketRays], t_num[kPacketRays];
  float edge_error[kPacketRays], den_error[kPacketRays], t_error[kPacketRays];
  float centre[3], spread[3], range_error;  // of the edge functions, where the origin is common
  std::uint32_t met;                        // triangles that some ray may cover
};

// Whether a ray that meets a child's box is lost by the test for all rays together.
struct LostRays {
  bool made = false;
  bool lost = false;     // of the children met
  bool too_far = false;  // met, but behind the common near value
};

}  // namespace plumb::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR
bool MakeWhole(const Ray* rays, float greatest, PacketRays& packet, PacketSlabs& slabs) {
  for (std::uint32_t i = 0; i < kPacketRays; ++i) packet.index[i] = i;
  return LoadRays(rays, kPacketRays, packet).one_octant() && MakePacket(greatest, packet, slabs);
}
#endif

void Values(const Ray* rays, const TriangleBlock<4>& block, float greatest, PacketValues& values) {
#if HWY_TARGET != HWY_SCALAR
  PacketRays packet;
  PacketSlabs slabs;
  if (!MakeWhole(rays, greatest, packet, slabs)) return;
  LeafTerms<4> terms;
  values.made = true;
  values.common_origin = packet.common_origin;
  values.met = MakeLeafTerms(packet, block, terms);
  const hn::CappedTag<float, kPacketRays> d;
  for (size_t i = 0; i < kPacketRays; i += hn::Lanes(d)) {
    hn::Vec<decltype(d)> edge0, edge1, edge2, error, den, size_error, t_num, along_error;
    RayValues(d, packet, block, terms, 0, i, edge0, edge1, edge2, error, den, size_error, t_num, along_error);
    hn::StoreU(edge0, d, values.edge[0] + i);
    hn::StoreU(edge1, d, values.edge[1] + i);
    hn::StoreU(edge2, d, values.edge[2] + i);
    hn::StoreU(den, d, values.den + i);
    hn::StoreU(t_num, d, values.t_num + i);
    hn::StoreU(error, d, values.edge_error + i);
    hn::StoreU(size_error, d, values.den_error + i);
    hn::StoreU(along_error, d, values.t_error + i);
  }
  if (!packet.common_origin) return;
  const hn::CappedTag<float, 4> d4;
  hn::Vec<decltype(d4)> edge0, edge1, edge2, spread0, spread1, spread2;
  EdgeRanges(d4, packet, terms, 0, edge0, edge1, edge2, spread0, spread1, spread2);
  values.centre[0] = hn::GetLane(edge0);
  values.centre[1] = hn::GetLane(edge1);
  values.centre[2] = hn::GetLane(edge2);
  values.spread[0] = hn::GetLane(spread0);
  values.spread[1] = hn::GetLane(spread1);
  values.spread[2] = hn::GetLane(spread2);
  values.range_error = values.edge_error[0] / packet.edge_scale * packet.box_scale;
#else
  (void)rays, (void)block, (void)greatest, (void)values;
#endif
}

void Boxes(const Ray* rays, const WideNode<8>& node, float greatest, LostRays& lost) {
#if HWY_TARGET != HWY_SCALAR
  PacketRays packet;
  PacketSlabs slabs;
  if (!MakeWhole(rays, greatest, packet, slabs)) return;
  lost.made = true;
  HWY_ALIGN float near[8];
  float limit = -1.0f;
  for (const float of_ray : packet.limit) limit = HWY_MAX(limit, of_ray);
  const std::uint32_t met = TestBoxes<8>(node, slabs, StayingBoxRay::finite(limit), near);
  for (size_t child = 0; child < 8; ++child) {
    const std::uint32_t together = MeetBox<8>(packet, slabs, packet.limit, &node.bounds[0][child]);
    std::uint32_t alone_bits = 0, exact_bits = 0;
    bool stays = false;
    for (size_t i = 0; i < kPacketRays; ++i) {
      const BoxRay moving(rays[i], greatest);
      const StayingBoxRay staying(rays[i], greatest);
      HWY_ALIGN float near_alone[8];
      const std::uint32_t bits =
          staying.in_range ? TestBoxes<8>(node, staying, StayingBoxRay::finite(packet.limit[i]), near_alone)
                           : TestBoxes<8>(node, moving, packet.limit[i], near_alone);
      const bool meets = (bits >> child & 1u) != 0;
      const float lo[3] = {node.bounds[0][child], node.bounds[2][child], node.bounds[4][child]};
      const float hi[3] = {node.bounds[1][child], node.bounds[3][child], node.bounds[5][child]};
      float near_exact = 0.0f;
      const bool holds = ExactBoxRay(rays[i]).meets(lo, hi, packet.limit[i], near_exact);
      exact_bits |= std::uint32_t{holds} << i;
      stays = stays || packet.stays[0] || packet.stays[1] || packet.stays[2];
      alone_bits |= std::uint32_t{meets} << i;
      lost.too_far = lost.too_far || (meets && near[child] > near_alone[child]);
    }
    // What all tests must keep; where no ray stays on an axis the two float tests are the same operations.
    lost.lost = lost.lost || (exact_bits & ~alone_bits) != 0 || (exact_bits & ~together) != 0;
    lost.lost = lost.lost || (!stays && alone_bits != together) ||
                ((alone_bits | together) != 0 && (met >> child & 1u) == 0);
  }
#else
  (void)rays, (void)node, (void)greatest, (void)lost;
#endif
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "attack/climb.h"
#include "attack/exact_values.h"
#include "base/simd_dispatch.h"
#include "support/effort.h"
#include "wide/triangle_block.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(Values);
HWY_EXPORT(Boxes);

using attack::Input;
using Rays = std::array<Ray, kPacketRays>;

// Rays about an input's, their directions' components up to `spread` times as long, their origins up to
// `apart` times the direction away.
Rays rays_about(const Input& input, float spread, float apart) {
  Rays rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto share = [&](std::size_t axis) { return static_cast<float>((7 * i + 5 * axis) % 16) / 16.0f; };
    const glm::vec3 d = input.direction();
    rays[i].direction = {d.x * (1.0f + spread * share(0)), d.y * (1.0f + spread * share(1)),
                         d.z * (1.0f + spread * share(2))};
    rays[i].origin = input.origin() + glm::vec3(share(3), share(4), share(5)) * d * apart;
  }
  return rays;
}

float greatest_of(const Input& input) {
  float greatest = 0.0f;
  for (std::size_t i = 6; i < input.value.size(); ++i)
    greatest = std::max(greatest, std::fabs(input.value[i]));
  return greatest;
}

struct Shares {
  double edge = 0.0, den = 0.0, t_num = 0.0, range = 0.0;
};

// Negative where no packet was made.
double shares_of(Simd simd, const Input& input, float spread, float apart, double Shares::*share) {
  const Triangle triangle = input.triangle();
  const float greatest = greatest_of(input);
  const Rays rays = rays_about(input, spread, apart);
  if (!triangle_is_finite(triangle)) return -1.0;
  const glm::uvec3 corners[1] = {{0, 1, 2}};
  const glm::vec3 positions[3] = {triangle.v0, triangle.v1, triangle.v2};
  TriangleBlock<4> block{};
  set_triangle(block, 0, MeshView{positions, corners}, 0, 0);
  PacketValues values;
  PLUMB_DISPATCH(Values, simd)(rays.data(), block, greatest, values);
  if (!values.made) return -1.0;
  Shares shares;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const attack::ExactValues exact(rays[i].origin, rays[i].direction, triangle);
    for (std::size_t e = 0; e < 3; ++e) {
      shares.edge = std::max(shares.edge, attack::share_of_bound(double{values.edge[e][i]}, exact.edge[e],
                                                                 double{values.edge_error[i]}));
      if (!values.common_origin) continue;
      // How far beyond an end of the range.
      const double most = double{values.centre[e]} + double{values.spread[e]};
      const double least = double{values.centre[e]} - double{values.spread[e]};
      const mpf_class scaled(exact.edge[e], 4096);
      const double value = mpf_class(scaled >> attack::kScaleBits).get_d();
      const double beyond = std::max(value - most, least - value);
      if (beyond > 0.0) shares.range = std::max(shares.range, beyond / double{values.range_error});
    }
    shares.den = std::max(
        shares.den, attack::share_of_bound(double{values.den[i]}, exact.den, double{values.den_error[i]}));
    shares.t_num = std::max(shares.t_num, attack::share_of_bound(double{values.t_num[i]}, exact.t_num,
                                                                 double{values.t_error[i]}));
  }
  return shares.*share;
}

double tightest(Simd simd, std::uint64_t seed, double Shares::*share) {
  hard::Random random(seed);
  double greatest = -1.0;
  for (const float apart : {0.0f, 0.125f}) {
    for (const float spread : {0.0f, 0x1p-10f, 3.0f}) {
      const auto draw = [&](hard::Random& r) { return attack::random_input(r, 0, 3); };
      const auto objective = [&](const Input& input) { return shares_of(simd, input, spread, apart, share); };
      greatest =
          std::max(greatest, attack::climb(random, hard::effort(4), hard::effort(800), draw, objective));
    }
  }
  return greatest;
}

// A node of boxes about the input's corners, some flat, some with faces where the rays begin.
WideNode<8> node_about(const Input& input, hard::Random& random) {
  WideNode<8> node{};
  for (std::size_t child = 0; child < 8; ++child) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float a = input.value[6 + 3 * random.below(3) + axis];
      const float b = random.one_in(4) ? input.value[axis] : input.value[6 + 3 * random.below(3) + axis];
      node.bounds[2 * axis][child] = std::min(a, b);
      node.bounds[2 * axis + 1][child] = std::max(a, b);
    }
  }
  return node;
}

}  // namespace

TEST_SUITE("attack: packets") {
  TEST_CASE("the bounds hold on every target, and the search comes near them") {
    struct {
      std::string name;
      double Shares::*share;
      double found;  // what the search is known to reach
    } const bounds[] = {{"edge functions", &Shares::edge, 0.15},
                        {"their sum", &Shares::den, 0.2},
                        {"det(a, b, c)", &Shares::t_num, 0.2},
                        {"ranges", &Shares::range, 0.0}};
    std::uint64_t seed = 1;
    for (const Simd simd : simd_targets()) {
      if (simd == Simd::Scalar) continue;  // no packets there
      for (const auto& bound : bounds) {
        const double share = tightest(simd, ++seed, bound.share);
        MESSAGE(std::string(simd_name(simd))
                << ", " << bound.name << ": the greatest error found is " << share << " of its bound");
        CHECK(share <= 1.0);
        CHECK(share >= bound.found / hard::kEffortDivisor);
      }
    }
  }

  TEST_CASE("what stands for all rays keeps every box that one of them keeps") {
    hard::Random random(7);
    int made = 0;
    for (int i = 0; i < hard::effort(3000); ++i) {
      const Input input = attack::random_input(random, random.between(-8, 8), 6);
      const float spread = random.one_in(2) ? 0x1p-6f : 2.0f;
      Rays rays = rays_about(input, spread, random.one_in(2) ? 0.0f : 0.25f);
      // Along planes and axes, whose rays stay at a coordinate; some at a face of the boxes.
      for (int axis = 0; axis < 3; ++axis) {
        if (!random.one_in(4)) continue;
        const float at = input.value[6 + 3 * random.below(3) + static_cast<std::size_t>(axis)];
        const bool same = random.one_in(2);
        for (Ray& ray : rays) {
          ray.direction[axis] = random.one_in(2) ? 0.0f : -0.0f;
          if (same) ray.origin[axis] = at;
        }
      }
      for (Ray& ray : rays) {
        if (random.one_in(4)) ray.tmin = random.unit();
        if (random.one_in(4)) ray.tmax = random.unit() + 1.0f;
      }
      const WideNode<8> node = node_about(input, random);
      float greatest = greatest_of(input);
      for (std::size_t k = 0; k < 3; ++k) greatest = std::max(greatest, std::fabs(input.value[k]));
      for (const Simd simd : simd_targets()) {
        LostRays lost;
        PLUMB_DISPATCH(Boxes, simd)(rays.data(), node, greatest, lost);
        made += lost.made ? 1 : 0;
        CAPTURE(simd_name(simd));
        CHECK(!lost.lost);
        CHECK(!lost.too_far);
      }
    }
    CHECK(made > 0);
  }
}

}  // namespace plumb::detail
#endif
