// Sets a mesh's triangles up for the tiles. Included once per Highway target.

#if defined(PLUMB_RASTER_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_SETUP_INL_H_
#undef PLUMB_RASTER_SETUP_INL_H_
#else
#define PLUMB_RASTER_SETUP_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "pixels/projection.h"
#include "pixels/screen_triangle.h"
#include "pixels/tile_planes-inl.h"
#include "pixels/triangle_setup-inl.h"
#include "raster/candidates-inl.h"
#include "raster/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

HWY_INLINE void StoreBox(const SetupCandidates& from, size_t i, ScreenTriangle& to) {
  to.nearest = from.nearest[i];
  to.index = from.index[i];
  to.x0 = from.x0[i];
  to.y0 = from.y0[i];
  to.x1 = from.x1[i];
  to.y1 = from.y1[i];
}

HWY_INLINE void StoreWide(const SetupLanes& lanes, size_t lane, const SetupCandidates& from, size_t i,
                          bool side_open, ScreenTriangle& to) {
  for (int k = 0; k < 4; ++k) {
    to.a[k] = lanes.a[k][lane];
    to.b[k] = lanes.b[k][lane];
    to.c[k] = lanes.c[k][lane];
    to.error[k] = lanes.error[k][lane];
  }
  StoreBox(from, i, to);
  to.side_open = side_open;
}

// Nothing is known but the box: every pixel in it is decided exactly.
inline void SetUpExactly(const SetupCandidates& from, const BinnedTriangles& to, SetupCounts& made) {
  for (size_t i = 0; i < from.count; ++i) {
    ScreenTriangle& triangle = to.wide[made.wide++];
    triangle = ScreenTriangle{};
    std::fill(std::begin(triangle.error), std::end(triangle.error), std::numeric_limits<float>::infinity());
    StoreBox(from, i, triangle);
  }
}

// Sets up the candidates, after those already made.
inline void SetUpCandidates(const Projection& view, const SetupCandidates& from, const BinnedTriangles& to,
                            SetupCounts& made) {
  const int tile_columns = (view.width - 1) / kTilePx + 1;
  const SetupTag d;
  const size_t width = hn::Lanes(d);
  static_assert(kTilePx == 32);
  const auto tile_begin = [&](const std::int32_t* side) HWY_ATTR {
    const hn::Rebind<std::int32_t, SetupTag> di;
    return hn::PromoteTo(d, hn::ShiftLeft<5>(hn::ShiftRight<5>(hn::LoadU(di, side))));
  };
  SetupLanes lanes;
  for (size_t first = 0; first < from.count; first += width) {
    std::uint32_t side_open = 0, uncovered = 0;
    SetUpLanes(view, from, first, lanes, side_open, uncovered);
    PlaceLanes(tile_begin(from.x0 + first), tile_begin(from.y0 + first), lanes);
    const std::uint32_t all = (1u << std::min(width, from.count - first)) - 1;
    for (std::uint32_t bits = all & ~uncovered; bits != 0; bits &= bits - 1) {
      const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
      const size_t i = first + lane;
      const bool open = (side_open >> lane & 1) != 0;
      const bool one_tile = ((from.x0[i] ^ from.x1[i]) | (from.y0[i] ^ from.y1[i])) < kTilePx;
      if (one_tile && !open) {
        TileTriangle& triangle = to.placed[made.placed++];
        StorePlaced(lanes, lane, from, i, triangle);
        triangle.tile =
            static_cast<std::uint32_t>(from.y0[i] / kTilePx * tile_columns + from.x0[i] / kTilePx);
      } else {
        StoreWide(lanes, lane, from, i, open, to.wide[made.wide++]);
      }
    }
  }
}

inline SetupCounts SetUpTriangles(const Projection& view, MeshView mesh, size_t first, size_t last,
                                  const BinnedTriangles& to) {
  SetupCandidates candidates;
  SetupCounts made{0, 0};
  for (size_t i = first; i < last; i += kSetupGroup) {
    FindCandidates(view, mesh, i, std::min(i + kSetupGroup, last), candidates);
    if (view.exact_only) {
      SetUpExactly(candidates, to, made);
    } else {
      SetUpCandidates(view, candidates, to, made);
    }
  }
  return made;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
