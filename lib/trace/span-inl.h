// The span calls on a wide tree in exact arithmetic: which rays go together, as packets, and which alone.
// Included once per Highway target.

#if defined(PLUMB_TRACE_SPAN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TRACE_SPAN_INL_H_
#undef PLUMB_TRACE_SPAN_INL_H_
#else
#define PLUMB_TRACE_SPAN_INL_H_
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "trace/exact_tests-inl.h"
#include "trace/packet-inl.h"
#include "trace/packet.h"
#include "trace/packet_rays-inl.h"
#include "trace/query.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

#if HWY_TARGET != HWY_SCALAR

// Rays that follow each other in a span and share an octant of directions are taken to be neighbours, as a
// camera's are, and make a packet as they come. The others of a stretch of the span wait for rays of their
// octant; these packets fall apart sooner.
template <class Tree>
class SpanTracer {
 public:
  SpanTracer(const Tree& tree, const Ray* rays, std::size_t count)
      : tree_(tree), rays_(rays), count_(count) {}

  void closest(Hit* hits) const {
    trace<ClosestPacket>(
        [&](std::size_t begin, const PacketRays& packet, const ClosestPacket& state) {
          for (size_t i = 0; i < packet.count; ++i) {
            hits[begin + packet.index[i]] = {state.best_t[i], state.best_id[i]};
          }
        },
        [&](std::size_t i) {
          closest_one_by_one<Tree, ExactTraversal<Tree>>(&tree_, rays_ + i, hits + i, 1);
        });
  }

  void any(bool* hits) const {
    trace<AnyPacket>(
        [&](std::size_t begin, const PacketRays& packet, const AnyPacket& state) {
          for (size_t i = 0; i < packet.count; ++i)
            hits[begin + packet.index[i]] = (state.hit >> i & 1u) != 0;
        },
        [&](std::size_t i) { any_one_by_one<Tree, ExactTraversal<Tree>>(&tree_, rays_ + i, hits + i, 1); });
  }

 private:
  static constexpr std::uint32_t kStretch = 512;
  static constexpr std::uint32_t kLeastPacket = 6;  // fewer rays are not worth one
  static constexpr float kMostApart = 0.25f;        // origins, as a share of the scene
  // Up to so many rays take a subtree one by one.
  static constexpr int kFewNeighbours = 1;
  template <class State>
  static constexpr int kFewStrangers = State::kOrdered ? 5 : 2;

  template <class State, class Answer, class Single>
  HWY_INLINE void trace(const Answer& answer, const Single& single) const {
    PacketRays packet;
    PacketSlabs slabs;
    std::uint32_t waiting[8][kStretch];
    for (std::size_t begin = 0; begin < count_; begin += kStretch) {
      // Of the rays from `begin` on that packet.index names, loaded.
      const auto together = [&](int few) HWY_ATTR {
        if (packet.count < kLeastPacket || !MakePacket(tree_.greatest, packet, slabs) || !are_near(slabs)) {
          for (size_t i = 0; i < packet.count; ++i) single(begin + packet.index[i]);
          return;
        }
        State state(packet);
        PacketTraversal<Tree, State> traversal(tree_, packet, slabs, state, few);
        traversal.run();
        if constexpr (State::kOrdered) Settle(tree_, packet, state);
        answer(begin, packet, state);
      };
      std::uint32_t waits[8] = {};
      const auto stretch = static_cast<std::uint32_t>(std::min<std::size_t>(kStretch, count_ - begin));
      for (std::uint32_t first = 0; first < stretch; first += kPacketRays) {
        const std::uint32_t count = std::min<std::uint32_t>(kPacketRays, stretch - first);
        for (std::uint32_t i = 0; i < kPacketRays; ++i) packet.index[i] = first + i;
        const PacketSigns signs = LoadRays(rays_ + begin, count, packet);
        if (signs.one_octant()) {
          together(kFewNeighbours);
          continue;
        }
        for (std::uint32_t i = 0; i < count; ++i) {
          const std::uint32_t octant = signs.octant(i);
          waiting[octant][waits[octant]++] = first + i;
        }
      }
      for (int octant = 0; octant < 8; ++octant) {
        for (std::uint32_t i = 0; i < waits[octant]; i += kPacketRays) {
          const std::uint32_t count = std::min<std::uint32_t>(kPacketRays, waits[octant] - i);
          std::copy_n(waiting[octant] + i, count, packet.index);
          LoadRays(rays_ + begin, count, packet);
          together(kFewStrangers<State>);
        }
      }
    }
  }

  // Whether the origins lie together enough that rays of one octant meet many of the same boxes.
  bool are_near(const PacketSlabs& slabs) const {
    float apart = 0.0f, size = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      apart += std::fabs(slabs.origin_near[axis] - slabs.origin_far[axis]);
      size += tree_.box.hi[axis] - tree_.box.lo[axis];
    }
    return apart <= kMostApart * size;
  }

  const Tree& tree_;
  const Ray* rays_;
  std::size_t count_;
};

#endif

// make_query_table() whose span calls trace packets.
template <class Tree>
QueryTable MakeSpanQueryTable() {
  QueryTable table = make_query_table<Tree, ExactTraversal<Tree>>();
#if HWY_TARGET != HWY_SCALAR
  table.closest = [](const void* structure, const Ray* rays, Hit* hits, std::size_t count) {
    if (count == 1) return closest_one_by_one<Tree, ExactTraversal<Tree>>(structure, rays, hits, 1);
    SpanTracer<Tree>(*static_cast<const Tree*>(structure), rays, count).closest(hits);
  };
  table.any = [](const void* structure, const Ray* rays, bool* hits, std::size_t count) {
    if (count == 1) return any_one_by_one<Tree, ExactTraversal<Tree>>(structure, rays, hits, 1);
    SpanTracer<Tree>(*static_cast<const Tree*>(structure), rays, count).any(hits);
  };
#endif
  return table;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
