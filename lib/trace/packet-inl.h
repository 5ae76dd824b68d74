// Packets of rays through a wide tree, in exact arithmetic. Included once per Highway target.
//
// After Wald, Slusallek, Benthin and Wagner 2001, "Interactive Rendering with Coherent Ray Tracing", and
// Boulos, Wald and Shirley 2006, "Geometric and Arithmetic Culling Methods for Entire Ray Packets": a
// node's boxes are tested at once against what bounds all rays (PacketSlabs). The rays themselves, in lanes,
// take the test of a child's box only when its turn comes, with the limits that they have by then. What few
// rays reach is left to them one by one.

#if defined(PLUMB_TRACE_PACKET_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_PACKET_INL_H_
#undef PLUMB_TRACE_PACKET_INL_H_
#else
#define PLUMB_TRACE_PACKET_INL_H_
#endif

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <new>
#include <type_traits>

#include "base/mask_bits-inl.h"
#include "exact/depth-inl.h"
#include "exact/filter-inl.h"
#include "exact/intersect.h"
#include "hwy/highway.h"
#include "trace/box_ray.h"
#include "trace/exact_tests-inl.h"
#include "trace/packet.h"
#include "trace/packet_tests-inl.h"
#include "trace/query.h"
#include "trace/traverse-inl.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// One ray of a packet as a query, for a subtree that few rays reach.
template <class Tree>
class ClosestOfPacket : public NoCounts {
 public:
  static constexpr bool kBoundsDepth = true;
  static constexpr bool kOrdered = true;
  static constexpr bool kAnyHit = false;

  ClosestOfPacket(const Tree& tree, const PacketRays& packet, ClosestPacket& state, std::size_t ray)
      : tree_(tree), packet_(packet), state_(state), ray_(ray) {}
  float limit() const { return state_.limit[ray_]; }
  bool take(float t, std::uint32_t id) {
    state_.take(packet_, ray_, t, id);
    return false;
  }
  // As ClosestQuery's.
  bool take_bounds(float low, float high, const LaneTriangle& triangle) {
    if (!(low > packet_.tmin[ray_]) || !(high <= packet_.tmax[ray_])) return false;
    if (low > state_.best_t[ray_] || low > state_.high[ray_]) return true;
    if (!(high < state_.low[ray_])) return false;
    // Blocks are aligned to their rows.
    state_.lane[ray_] = static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(triangle.corner) /
                                                   sizeof(float) % Tree::kWidth);
    state_.block[ray_] = place_of(triangle.corner);
    state_.low[ray_] = low;
    state_.high[ray_] = high;
    state_.limit[ray_] = std::min(state_.limit[ray_], depth_limit(high));
    return true;
  }
  static constexpr bool done() { return false; }
  void at_block(std::uint32_t place) { place_ = place; }

 private:
  // The block's that a lane lies in.
  std::uint32_t place_of(const float* corner) const {
    if constexpr (std::is_same_v<Tree, WideTree<Tree::kWidth>>) {
      const auto offset = static_cast<std::size_t>(reinterpret_cast<const char*>(corner) -
                                                   reinterpret_cast<const char*>(tree_.blocks.data()));
      return static_cast<std::uint32_t>(offset / sizeof tree_.blocks[0]);
    } else {
      return place_;
    }
  }

  const Tree& tree_;
  const PacketRays& packet_;
  ClosestPacket& state_;
  std::size_t ray_;
  std::uint32_t place_ = 0;  // of what is unpacked
};

template <class Tree>
class AnyOfPacket : public AnyQuery {
 public:
  AnyOfPacket(const Tree&, const PacketRays& packet, AnyPacket& state, std::size_t ray)
      : AnyQuery(packet.ray(ray)), state_(state), ray_(ray) {}
  ~AnyOfPacket() {
    if (result()) state_.close(ray_);
  }
  AnyOfPacket(const AnyOfPacket&) = delete;
  AnyOfPacket& operator=(const AnyOfPacket&) = delete;

 private:
  AnyPacket& state_;
  std::size_t ray_;
};

template <class Tree, class State>
using SingleOf = std::conditional_t<State::kOrdered, ClosestOfPacket<Tree>, AnyOfPacket<Tree>>;

// Offers a triangle to rays [i, i + Lanes(d)) that meet it for certain (`certain`) with t between `low` and
// `high`, as ClosestQuery::take_bounds does. Returns those for which the bounds say enough.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE M TakeBounds(D d, const PacketRays& packet, ClosestPacket& state, size_t i, M certain, V low,
                        V high, std::uint32_t block, std::uint32_t lane) {
  const V waits_low = hn::Load(d, state.low + i);
  const auto counts = hn::And(certain, hn::And(hn::Gt(low, hn::Load(d, packet.tmin + i)),
                                               hn::Le(high, hn::Load(d, packet.tmax + i))));
  const auto farther = hn::And(
      counts, hn::Or(hn::Gt(low, hn::Load(d, state.best_t + i)), hn::Gt(low, hn::Load(d, state.high + i))));
  const auto nearer = hn::AndNot(farther, hn::And(counts, hn::Lt(high, waits_low)));
  const hn::RebindToUnsigned<D> du;
  const V limit = hn::Load(d, state.limit + i);
  // depth_limit(high), which is finite and above 0.
  const V next = hn::BitCast(d, hn::Add(hn::BitCast(du, high), hn::Set(du, 1)));
  hn::Store(hn::IfThenElse(nearer, hn::Min(limit, next), limit), d, state.limit + i);
  hn::Store(hn::IfThenElse(nearer, low, waits_low), d, state.low + i);
  hn::Store(hn::IfThenElse(nearer, high, hn::Load(d, state.high + i)), d, state.high + i);
  const auto nearer_u = hn::RebindMask(du, nearer);
  hn::Store(hn::IfThenElse(nearer_u, hn::Set(du, block), hn::Load(du, state.block + i)), du, state.block + i);
  hn::Store(hn::IfThenElse(nearer_u, hn::Set(du, lane), hn::Load(du, state.lane + i)), du, state.lane + i);
  return hn::Or(farther, nearer);
}

// The same as AnyQuery::take_bounds does.
template <class D, class V = hn::Vec<D>, class M = hn::Mask<D>>
HWY_INLINE M TakeBounds(D d, const PacketRays& packet, AnyPacket& state, size_t i, M certain, V low, V high,
                        std::uint32_t, std::uint32_t) {
  const V tmin = hn::Load(d, packet.tmin + i);
  const V tmax = hn::Load(d, packet.tmax + i);
  const auto hit = hn::And(certain, hn::And(hn::Gt(low, tmin), hn::Le(high, tmax)));
  state.hit |= MaskBits(d, hit) << i;
  hn::Store(hn::IfThenElse(hit, hn::Set(d, -1.0f), hn::Load(d, state.limit + i)), d, state.limit + i);
  const auto misses =
      hn::And(certain, hn::And(hn::Gt(low, hn::Zero(d)), hn::Or(hn::Le(high, tmin), hn::Gt(low, tmax))));
  return hn::Or(hit, misses);
}

template <class Tree, class State>
class PacketTraversal {
  static constexpr int W = Tree::kWidth;

 public:
  // Up to `few` rays take a subtree one by one.
  PacketTraversal(const Tree& tree, const PacketRays& packet, const PacketSlabs& slabs, State& state, int few)
      : tree_(tree), packet_(packet), slabs_(slabs), state_(state), few_(few), limit_(greatest_limit()) {}

  HWY_NOINLINE void run() {
    // Of a child whose box all rays together may meet.
    struct Entry {
      const float* bounds;
      float near;
      std::uint32_t child, count;
    };
    Entry stack[W * kMaxTreeDepth];
    Entry* top = stack;
    std::uint32_t child = 0, count = 0, rays = (1u << kPacketRays) - 1u;
    for (;;) {
      if (std::popcount(rays) <= few_) {
        one_by_one(child, count, rays);
      } else if (count != 0) {
        leaf(child, count, rays);
      } else {
        const WideNode<W>& node = tree_.nodes[child];
        HWY_ALIGN float near[W];
        std::uint32_t met = TestBoxes<W>(node, slabs_, limit_, near);
        Entry* const base = top;
        for (; met != 0; met &= met - 1) {
          const auto i = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(met));
          Entry* place = top++;
          if constexpr (State::kOrdered) {
            for (; place != base && place[-1].near < near[i]; --place) *place = place[-1];
          }
          *place = {&node.bounds[0][i], near[i], node.child[i], node.count[i]};
        }
      }
      do {
        if (top == stack) return;
        --top;
        rays = top->near > limit_ ? 0 : MeetBox<W>(packet_, slabs_, state_.limit, top->bounds);
      } while (rays == 0);
      child = top->child;
      count = top->count;
    }
  }

 private:
  float greatest_limit() const {
    const hn::CappedTag<float, kPacketRays> d;
    auto greatest = hn::Load(d, state_.limit);
    for (size_t i = hn::Lanes(d); i < kPacketRays; i += hn::Lanes(d)) {
      greatest = hn::Max(greatest, hn::Load(d, state_.limit + i));
    }
    return StayingBoxRay::finite(hn::GetLane(hn::MaxOfLanes(d, greatest)));
  }

  void one_by_one(std::uint32_t child, std::uint32_t count, std::uint32_t rays) {
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rays));
      SingleOf<Tree, State> query(tree_, packet_, state_, i);
      ExactTests<W>& tests = tests_of(i);
      tests.set_limit(query.limit());
      Traverse(tree_, tests, query, {0.0f, child, count});
    }
    limit_ = greatest_limit();
  }

  // Most rays of a packet come here never or often, so their tests are made at the first time and kept.
  ExactTests<W>& tests_of(std::size_t i) {
    if ((made_ >> i & 1u) == 0) {
      new (tests_[i]) ExactTests<W>(tree_.greatest, packet_.ray(i), state_.limit[i]);
      made_ |= 1u << i;
    }
    return *std::launder(reinterpret_cast<ExactTests<W>*>(tests_[i]));
  }

  void leaf(std::uint32_t child, std::uint32_t count, std::uint32_t rays) {
    for (;; child = NextBlock(tree_, child)) {
      TriangleBlock<W> room;
      const TriangleBlock<W>& block = BlockOf(tree_, child, room);
      LeafTerms<W> terms;
      std::uint32_t met = MakeLeafTerms(packet_, block, terms);
      if (count < static_cast<std::uint32_t>(W)) met &= (1u << count) - 1u;
      for (; met != 0; met &= met - 1) {
        const auto lane = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(met));
        triangle(block, terms, child, lane, rays);
      }
      if (count <= static_cast<std::uint32_t>(W)) break;
      count -= static_cast<std::uint32_t>(W);
    }
    limit_ = greatest_limit();
  }

  HWY_INLINE void triangle(const TriangleBlock<W>& block, const LeafTerms<W>& terms, std::uint32_t index,
                           std::uint32_t lane, std::uint32_t rays) {
    const hn::CappedTag<float, kPacketRays> d;
    using V = hn::Vec<decltype(d)>;
    const hn::RebindToUnsigned<decltype(d)> du;
    for (size_t i = 0; i < kPacketRays; i += hn::Lanes(d)) {
      // FilterRay::set_limit's.
      const V limit = hn::Load(d, state_.limit + i);
      const V next = hn::BitCast(d, hn::Add(hn::BitCast(du, limit), hn::Set(du, 1)));
      const V infinity = hn::Set(d, std::numeric_limits<float>::infinity());
      const V filter_limit =
          hn::Mul(hn::IfThenElse(hn::Lt(limit, infinity), next, limit), hn::Set(d, 1.0f + 0x1p-20f));
      hn::Mask<decltype(d)> possible, certain;
      V along, along_error, size, size_error;
      FilterRays(d, packet_, block, terms, lane, i, filter_limit, possible, certain, along, along_error, size,
                 size_error);
      std::uint32_t open = MaskBits(d, possible) << i & rays;
      if (open == 0) continue;
      V low, high;
      DepthBounds(d, along, along_error, size, size_error, low, high);
      certain = hn::And(certain, MaskOfBits(d, open >> i));
      const auto taken = TakeBounds(d, packet_, state_, i, certain, low, high, index, lane);
      open &= ~(MaskBits(d, taken) << i);
      if (HWY_UNLIKELY(open != 0)) offer(block, lane, open, MaskBits(d, certain) << i);
    }
  }

  // Decides about a triangle and some rays, of which those in `covered` meet it for certain.
  HWY_NOINLINE void offer(const TriangleBlock<W>& block, std::uint32_t lane, std::uint32_t rays,
                          std::uint32_t covered) {
    const Triangle triangle = TriangleOf(block, lane);
    for (; rays != 0; rays &= rays - 1) {
      const auto i = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(rays));
      const bool sure = (covered >> i & 1u) != 0;
      if constexpr (State::kAnyHit) {
        if (ray_meets(packet_.ray(i), triangle, sure)) state_.close(i);
      } else if (!knows(i, block.id[lane])) {
        float t = 0.0f;
        if (ray_hit(packet_.ray(i), triangle, sure, state_.limit[i], t)) {
          state_.take(packet_, i, t, block.id[lane]);
        }
      }
    }
  }

  // Of another leaf, of a tree with spatial splits.
  bool knows(std::size_t i, std::uint32_t id) const {
    if (state_.best_id[i] == id) return true;
    return state_.low[i] < std::numeric_limits<float>::infinity() &&
           IdAt(tree_, state_.block[i], state_.lane[i]) == id;
  }

  const Tree& tree_;
  const PacketRays& packet_;
  const PacketSlabs& slabs_;
  State& state_;
  int few_;
  float limit_;  // the greatest of the rays', made finite
  std::uint32_t made_ = 0;
  static_assert(std::is_trivially_destructible_v<ExactTests<W>>);
  alignas(ExactTests<W>) unsigned char tests_[kPacketRays][sizeof(ExactTests<W>)];
};

// Computes the depths that wait, all at once where double arithmetic is enough, and takes those that count.
template <class Tree>
HWY_INLINE void Settle(const Tree& tree, const PacketRays& packet, ClosestPacket& state) {
  std::uint32_t waiting = 0;
  for (size_t i = 0; i < kPacketRays; ++i) {
    waiting |= std::uint32_t{state.low[i] < std::numeric_limits<float>::infinity()} << i;
  }
  if (waiting == 0) return;
  HWY_ALIGN float corner[9][kPacketRays];
  HWY_ALIGN std::uint32_t id[kPacketRays];
  for (size_t i = 0; i < kPacketRays; ++i) {
    const bool waits = (waiting >> i & 1u) != 0;
    // A triangle of any block where none waits: its depth is not taken.
    const std::uint32_t place = waits ? state.block[i] : 0, lane = waits ? state.lane[i] : 0;
    const Triangle triangle = TriangleAt(tree, place, lane);
    for (int axis = 0; axis < 3; ++axis) {
      corner[axis][i] = triangle.v0[axis];
      corner[3 + axis][i] = triangle.v1[axis];
      corner[6 + axis][i] = triangle.v2[axis];
    }
    id[i] = IdAt(tree, place, lane);
  }
  HWY_ALIGN float t[kPacketRays];
  std::uint32_t certain_bits = 0;
  {
    const hn::CappedTag<double, kPacketRays> d;
    const hn::Rebind<float, decltype(d)> df;
    for (size_t i = 0; i < kPacketRays; i += hn::Lanes(d)) {
      const auto promoted = [&](const float* from)
                                HWY_ATTR { return hn::PromoteTo(d, hn::Load(df, from + i)); };
      auto depth = hn::Zero(df);
      auto certain = hn::FirstN(df, 0);
      TriangleDepths(
          d, [&](int k) HWY_ATTR { return promoted(k < 3 ? packet.origin[k] : packet.direction[k - 3]); },
          [&](int k) HWY_ATTR { return promoted(corner[k]); }, depth, certain);
      hn::Store(depth, df, t + i);
      certain_bits |= MaskBits(df, certain) << i;
    }
  }
  for (std::uint32_t open = waiting & ~certain_bits; open != 0; open &= open - 1) {
    const auto i = static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(open));
    const Ray& ray = packet.ray(i);
    t[i] = line_depth(ray.origin, ray.direction, TriangleAt(tree, state.block[i], state.lane[i]));
  }
  // depth_counts() and hit_before().
  const hn::CappedTag<float, kPacketRays> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  for (size_t i = 0; i < kPacketRays; i += hn::Lanes(d)) {
    const auto depth = hn::Load(d, t + i), best = hn::Load(d, state.best_t + i);
    const auto ids = hn::Load(du, id + i), best_ids = hn::Load(du, state.best_id + i);
    const auto counts =
        hn::And(hn::And(MaskOfBits(d, waiting >> i), hn::Gt(depth, hn::Load(d, packet.tmin + i))),
                hn::Le(depth, hn::Load(d, packet.tmax + i)));
    const auto before =
        hn::Or(hn::Lt(depth, best), hn::And(hn::Eq(depth, best), hn::RebindMask(d, hn::Lt(ids, best_ids))));
    const auto taken = hn::And(counts, before);
    hn::Store(hn::IfThenElse(taken, depth, best), d, state.best_t + i);
    hn::Store(hn::IfThenElse(hn::RebindMask(du, taken), ids, best_ids), du, state.best_id + i);
  }
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
