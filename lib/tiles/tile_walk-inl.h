// A wide tree walked once for a tile of pixels, front to back. Boxes are culled that the tile's pixels cannot
// see or that lie behind all they see so far; the triangles of a leaf are set up and drawn as the
// rasterizer's are (pixels/). Included once per Highway target.
//
// So the cost grows with what the tile sees, not with what is there. Everything here only leaves out what
// certainly is not seen, hence the order of boxes and triangles does not matter to the answer.

#if defined(PLUMB_TILES_TILE_WALK_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_TILES_TILE_WALK_INL_H_
#undef PLUMB_TILES_TILE_WALK_INL_H_
#else
#define PLUMB_TILES_TILE_WALK_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/mask_bits-inl.h"
#include "build/binary_tree.h"
#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "pixels/block_draw-inl.h"
#include "pixels/candidate_draw-inl.h"
#include "pixels/float_bounds-inl.h"
#include "pixels/no_tile_counts.h"
#include "pixels/screen_bounds-inl.h"
#include "pixels/tile_frame-inl.h"
#include "tiles/tile_frustum.h"
#include "tiles/tile_kernel.h"
#include "tiles/tree_triangles.h"
#include "wide/wide_tree.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A plane at the corners of W boxes that `row` picks.
template <class D, int W>
HWY_INLINE hn::Vec<D> PlaneAtBoxes(D d, const BoxPlane& plane, const std::uint32_t row[3],
                                   const WideNode<W>& node, size_t lane) {
  auto value = hn::Set(d, plane.offset);
  for (int axis = 0; axis < 3; ++axis)
    value = hn::MulAdd(hn::Set(d, plane.normal[axis]), hn::Load(d, node.bounds[row[axis]] + lane), value);
  return value;
}

// The children that the tile may see, one bit each, and the least t of anything seen in their boxes or less.
// `low` >= 0 bounds the 1/t of all that the tile sees so far. An empty child's planes are -infinity or NaN:
// it is never met.
template <int W>
HWY_INLINE std::uint32_t MeetChildren(const WideNode<W>& node, const FrameFrustum& frame,
                                      const TileFrustum& tile, float low, float* near) {
  const hn::CappedTag<float, W> d;
  std::uint32_t met = 0;
  for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
    const auto inside = [&](int i) HWY_ATTR {
      const auto value = PlaneAtBoxes<decltype(d), W>(d, tile.side[i], tile.side[i].greatest_row, node, lane);
      return hn::Ge(value, hn::Zero(d));
    };
    const auto seen = hn::And(hn::And(inside(0), inside(1)), hn::And(inside(2), inside(3)));
    const auto depth = PlaneAtBoxes<decltype(d), W>(d, frame.depth, frame.depth.least_row, node, lane);
    auto first = hn::Mul(depth, hn::Set(d, frame.depth_scale));
    auto last = hn::Set(d, kFloatInfinity);
    for (const TileSlab& slab : tile.slab) {
      const auto eye = hn::Set(d, slab.eye);
      const auto to_near = hn::Sub(hn::Load(d, node.bounds[slab.near_row] + lane), eye);
      const auto to_far = hn::Sub(hn::Load(d, node.bounds[slab.far_row] + lane), eye);
      first = hn::Max(first, hn::Mul(to_near, hn::Set(d, slab.near_scale)));
      last = hn::Min(last, hn::MulAdd(to_far, hn::Set(d, slab.far_scale), hn::Set(d, slab.far_room)));
    }
    const auto room = hn::Set(d, kTileRoom);
    const auto missed = hn::Gt(first, hn::Mul(last, room));
    const auto hidden = hn::Gt(hn::Mul(first, hn::Set(d, low)), room);
    hn::Store(first, d, near + lane);
    met |= MaskBits(d, hn::AndNot(hn::Or(missed, hidden), seen)) << lane;
  }
  return met;
}

// Whether one of W triangles, of those whose bit is set, may cover the rectangle.
template <int W>
HWY_INLINE bool AnyWide(const ScreenBoxes& boxes, std::uint32_t seen, const PixelRect& rect) {
  const hn::CappedTag<std::int32_t, W> d;
  std::uint32_t bits = 0;
  for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d)) {
    const auto at = [&](const std::int32_t* side, std::int32_t edge)
                        HWY_ATTR { return hn::Eq(hn::Load(d, side + lane), hn::Set(d, edge)); };
    const auto wide = hn::And(hn::And(at(boxes.x0, rect.x0), at(boxes.x1, rect.x1)),
                              hn::And(at(boxes.y0, rect.y0), at(boxes.y1, rect.y1)));
    bits |= MaskBits(d, wide) << lane;
  }
  return (bits & seen) != 0;
}

struct TileWalkEntry {
  float near;  // the least t of what is in its box, or less
  std::uint32_t child;
  std::uint32_t count;  // triangles of a leaf; 0 for a node
};

template <int W>
class TileWalk {
 public:
  TileWalk(const WideTree<W>& tree, const FrameFrustum& frustum, const TileView& view, Frame& frame)
      : tree_(tree),
        triangles_{tree.blocks.data()},
        frustum_(frustum),
        view_(view),
        rect_{view.x, view.y, std::min(view.x + kTilePx, frame.width) - 1,
              std::min(view.y + kTilePx, frame.height) - 1},
        tile_(frustum, rect_.x0, rect_.y0, rect_.x1, rect_.y1) {
    candidates_.count = 0;
    std::fill(std::begin(added_), std::end(added_), kNone);
    state_.tile_low = -kFloatInfinity;
    walk();
    if (candidates_.count != 0) draw_candidates(candidates_.count);
    if (started_) {
      StoreTile(view_, triangles_, state_, frame);
    } else {
      ClearTile(view_, frame);
    }
  }

 private:
  void walk() {
    // Every node visited leaves at most W - 1 siblings on the stack.
    TileWalkEntry stack[(W - 1) * kMaxTreeDepth + 1];
    TileWalkEntry* top = stack;
    TileWalkEntry current{0.0f, 0, 0};
    for (;;) {
      if (current.count != 0) {
        leaf(current.child, current.count);
      } else {
        const WideNode<W>& node = tree_.nodes[current.child];
        HWY_ALIGN float near[W];
        std::uint32_t met = MeetChildren<W>(node, frustum_, tile_, low(), near);
        TileWalkEntry* const base = top;
        for (; met != 0; met &= met - 1) {
          const size_t i = hwy::Num0BitsBelowLS1Bit_Nonzero32(met);
          const TileWalkEntry entry{near[i], node.child[i], node.count[i]};
          prefetch(entry);
          TileWalkEntry* place = top++;
          for (; place != base && place[-1].near < entry.near; --place) *place = place[-1];
          *place = entry;
        }
      }
      do {
        if (top == stack) return;
        current = *--top;
      } while (current.near * low() > kTileRoom);
    }
  }

  // Fetches what waits on the stack meanwhile: a tile sees little of the tree, and its neighbours on the
  // screen need not be so in memory.
  HWY_INLINE void prefetch(const TileWalkEntry& entry) const {
    const auto lines = [](const auto* what) HWY_ATTR {
      const char* const bytes = reinterpret_cast<const char*>(what);
      for (size_t i = 0; i < sizeof(*what); i += 64) hwy::Prefetch(bytes + i);
    };
    if (entry.count != 0) {
      lines(&tree_.blocks[entry.child]);
    } else {
      lines(&tree_.nodes[entry.child]);
    }
  }

  // At most the 1/t of all that the tile sees, and at least 0.
  HWY_INLINE float low() const { return std::max(state_.tile_low, 0.0f); }

  HWY_INLINE void leaf(std::uint32_t block, std::uint32_t count) {
    for (;; ++block) {
      add_candidates(block, std::min(count, static_cast<std::uint32_t>(W)));
      // Whole vectors, but what may hide the rest is not kept waiting.
      const size_t ready =
          wide_ ? candidates_.count : candidates_.count / hn::Lanes(SetupTag()) * hn::Lanes(SetupTag());
      if (ready != 0) draw_candidates(ready);
      wide_ = false;
      if (count <= static_cast<std::uint32_t>(W)) return;
      count -= static_cast<std::uint32_t>(W);
    }
  }

  HWY_INLINE void add_candidates(std::uint32_t block, std::uint32_t count) {
    const TriangleBlock<W>& from = tree_.blocks[block];
    const float* corner[9];
    for (int k = 0; k < 9; ++k) corner[k] = from.vertex[k / 3][k % 3];
    ScreenBoxes boxes;
    std::uint32_t seen = BoundTriangles<W>(frustum_.view, rect_, corner, count, boxes);
    if (seen == 0) return;
    const hn::CappedTag<float, W> d;
    const auto low = hn::Set(d, state_.tile_low);
    for (size_t lane = 0; lane < static_cast<size_t>(W); lane += hn::Lanes(d))
      seen &= ~(MaskBits(d, hn::Lt(hn::Load(d, boxes.nearest + lane), low)) << lane);
    if (seen == 0) return;
    seen = not_yet_added(from.id, seen);
    wide_ |= AnyWide<W>(boxes, seen, rect_);
    AddCandidates(corner, boxes, seen, static_cast<size_t>(block) * W, candidates_);
  }

  // Of triangles whose bit is set, those that were not added of late: several leaves may have one
  // (Quality::Best), and a triangle is drawn into the whole tile at once. Drawn again it would change
  // nothing, but every pixel of it would be decided exactly.
  HWY_INLINE std::uint32_t not_yet_added(const std::uint32_t* id, std::uint32_t seen) {
    std::uint32_t fresh = 0;
    for (; seen != 0; seen &= seen - 1) {
      const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(seen);
      std::uint32_t& known = added_[id[lane] % kAdded];
      fresh |= std::uint32_t{known != id[lane]} << lane;
      known = id[lane];
    }
    return fresh;
  }

  // Draws the first candidates, as many as wanted, a vector at a time. A tile that sees nothing never comes
  // here, and is never started.
  void draw_candidates(size_t count) {
    if (!started_) {
      StartTile(view_, state_);
      started_ = true;
    }
    const SetupTag d;
    for (size_t first = 0; first < count; first += hn::Lanes(d))
      DrawCandidates(frustum_.view, view_, triangles_, candidates_, first,
                     std::min(hn::Lanes(d), count - first), state_, counts_);
    DropCandidates(count, candidates_);
    UpdateLows(state_);
  }

  const WideTree<W>& tree_;
  TreeTriangles<W> triangles_;
  const FrameFrustum& frustum_;
  const TileView& view_;
  PixelRect rect_;
  TileFrustum tile_;
  static constexpr size_t kAdded = 256;
  std::uint32_t added_[kAdded];  // the last id added of those with the same remainder, or kNone
  SetupCandidates candidates_;
  bool started_ = false;  // state_ is set but for tile_low
  bool wide_ = false;     // a candidate may hide all that is behind it
  TileState state_;
  [[no_unique_address]] NoTileCounts counts_;
};

template <int W>
TileCaster MakeTileCaster() {
  return {[](const void* structure) { return static_cast<const WideTree<W>*>(structure)->greatest; },
          [](const void* structure, const FrameFrustum& frustum, const TileView& view, Frame& frame) {
            TileWalk<W>(*static_cast<const WideTree<W>*>(structure), frustum, view, frame);
          }};
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
