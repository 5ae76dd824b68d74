// Which tiles may see which of a mesh's triangles. Included once per Highway target.

#if defined(PLUMB_RASTER_BINNING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_RASTER_BINNING_INL_H_
#undef PLUMB_RASTER_BINNING_INL_H_
#else
#define PLUMB_RASTER_BINNING_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <vector>

#include "hwy/cache_control.h"
#include "hwy/highway.h"
#include "pixels/float_bounds-inl.h"
#include "pixels/projection.h"
#include "pixels/screen_bounds-inl.h"
#include "pixels/screen_triangle.h"
#include "pixels/triangle_setup-inl.h"
#include "plumb/mesh.h"
#include "raster/kernels.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Triangles that are fetched at a time, and how many ahead their vertices are asked for.
constexpr size_t kFetched = 16;
constexpr size_t kFetchAhead = 32;

// Their corners, coordinate by coordinate.
struct FetchedCorners {
  alignas(64) float corner[9][kFetched];
};

HWY_INLINE void FetchCorners(MeshView mesh, size_t first, size_t count, FetchedCorners& to) {
  for (size_t lane = 0; lane < count; ++lane) {
    const glm::uvec3& c = mesh.triangles[first + lane];
    const glm::vec3* const vertex[3] = {&mesh.positions[c.x], &mesh.positions[c.y], &mesh.positions[c.z]};
    for (int v = 0; v < 3; ++v) {
      to.corner[3 * v][lane] = vertex[v]->x;
      to.corner[3 * v + 1][lane] = vertex[v]->y;
      to.corner[3 * v + 2][lane] = vertex[v]->z;
    }
  }
}

// Where the screen says nothing: every finite triangle may be anywhere in the frame.
HWY_INLINE std::uint32_t BoundNowhere(const Projection& view, const float* const corner[9], size_t count,
                                      ScreenBoxes& boxes) {
  std::uint32_t finite = 0;
  for (size_t i = 0; i < count; ++i) {
    float total = 0.0f;
    for (int k = 0; k < 9; ++k) total += corner[k][i] * 0.0f;
    finite |= std::uint32_t{total == 0.0f} << i;
    boxes.x0[i] = boxes.y0[i] = 0;
    boxes.x1[i] = view.width - 1;
    boxes.y1[i] = view.height - 1;
    boxes.nearest[i] = std::numeric_limits<float>::infinity();
  }
  return finite;
}

HWY_INLINE void StoreBox(const SetupCandidates& from, size_t i, ScreenTriangle& to) {
  to.nearest = from.nearest[i];
  to.index = from.index[i];
  to.x0 = from.x0[i];
  to.y0 = from.y0[i];
  to.x1 = from.x1[i];
  to.y1 = from.y1[i];
}

// Nothing is known but the boxes: every pixel in them is decided exactly.
inline void SetUpExactly(const SetupCandidates& from, std::vector<ScreenTriangle>& to) {
  for (size_t i = 0; i < from.count; ++i) {
    ScreenTriangle& triangle = to.emplace_back();
    // No depth is certain then either.
    std::fill(std::begin(triangle.error), std::end(triangle.error), std::numeric_limits<float>::infinity());
    std::fill(std::begin(triangle.plane), std::end(triangle.plane), std::numeric_limits<double>::quiet_NaN());
    StoreBox(from, i, triangle);
  }
}

// Sets wide triangles up.
inline void SetUpWide(const Projection& view, const SetupCandidates& from, std::vector<ScreenTriangle>& to) {
  if (view.exact_only) {
    SetUpExactly(from, to);
    return;
  }
  const size_t width = hn::Lanes(SetupTag());
  SetupLanes lanes;
  for (size_t first = 0; first < from.count; first += width) {
    std::uint32_t side_open = 0, uncovered = 0;
    SetUpLanes(view, from, first, lanes, side_open, uncovered);
    for (size_t i = first; i < std::min(first + width, from.count); ++i) {
      const size_t lane = i - first;
      if ((uncovered >> lane & 1) != 0) continue;
      ScreenTriangle& triangle = to.emplace_back();
      for (int k = 0; k < 4; ++k) {
        triangle.a[k] = lanes.a[k][lane];
        triangle.b[k] = lanes.b[k][lane];
        triangle.c[k] = lanes.c[k][lane];
        triangle.error[k] = lanes.error[k][lane];
      }
      for (int k = 0; k < 6; ++k) triangle.plane[k] = lanes.plane[k][lane];
      triangle.side_open = (side_open >> lane & 1) != 0;
      StoreBox(from, i, triangle);
    }
  }
}

// What boxes of pixels are in tiles.
struct TileBoxes {
  alignas(64) std::uint32_t tile[kFetched];  // that of the upper left pixel
  alignas(64) std::uint32_t box[kFetched];   // TileEntry's, where all of it lies there
  std::uint32_t one;                         // a bit where it does
  std::uint32_t few;                         // a bit where it lies within two tiles by two
};

HWY_INLINE void FindTiles(const ScreenBoxes& boxes, int tile_columns, TileBoxes& to) {
  const hn::CappedTag<std::int32_t, kFetched> d;
  const hn::RebindToUnsigned<decltype(d)> du;
  static_assert(kTilePx == 32);
  to.one = to.few = 0;
  for (size_t lane = 0; lane < kFetched; lane += hn::Lanes(d)) {
    const auto x0 = hn::Load(d, boxes.x0 + lane), y0 = hn::Load(d, boxes.y0 + lane);
    const auto x1 = hn::Load(d, boxes.x1 + lane), y1 = hn::Load(d, boxes.y1 + lane);
    const auto column = hn::ShiftRight<5>(x0), row = hn::ShiftRight<5>(y0);
    const auto more = hn::Max(hn::Sub(hn::ShiftRight<5>(x1), column), hn::Sub(hn::ShiftRight<5>(y1), row));
    to.one |= MaskBits(d, hn::Eq(more, hn::Zero(d))) << lane;
    to.few |= MaskBits(d, hn::Lt(more, hn::Set(d, 2))) << lane;
    const auto tile = hn::Add(hn::Mul(row, hn::Set(d, tile_columns)), column);
    hn::Store(hn::BitCast(du, tile), du, to.tile + lane);
    const auto inside = [&](auto side) HWY_ATTR { return hn::And(side, hn::Set(d, kTilePx - 1)); };
    const auto low = hn::Or(inside(x0), hn::ShiftLeft<8>(inside(y0)));
    const auto high = hn::Or(inside(x1), hn::ShiftLeft<8>(inside(y1)));
    hn::Store(hn::BitCast(du, hn::Or(low, hn::ShiftLeft<16>(high))), du, to.box + lane);
  }
}

// Lists a triangle with each tile of its box, with its part of it.
inline void AddToTiles(const ScreenBoxes& boxes, size_t lane, std::uint32_t index, int tile_columns,
                       TileLists& lists) {
  const auto clipped = [](int side, int tile) { return std::clamp(side - tile * kTilePx, 0, kTilePx - 1); };
  const int x0 = boxes.x0[lane], y0 = boxes.y0[lane], x1 = boxes.x1[lane], y1 = boxes.y1[lane];
  for (int row = y0 / kTilePx; row <= y1 / kTilePx; ++row) {
    for (int column = x0 / kTilePx; column <= x1 / kTilePx; ++column) {
      const std::uint32_t box =
          TileEntry::pack(clipped(x0, column), clipped(y0, row), clipped(x1, column), clipped(y1, row));
      lists.add(static_cast<std::uint32_t>(row * tile_columns + column), {index, boxes.nearest[lane], box});
    }
  }
}

inline void BinTriangles(const Projection& view, MeshView mesh, size_t first, size_t last,
                         BinnedTriangles& to) {
  const bool bounded = view.slack_px < kDoubleInfinity;
  const int tile_columns = (view.width - 1) / kTilePx + 1;
  FetchedCorners fetched{};
  const float* corner[9];
  for (int k = 0; k < 9; ++k) corner[k] = fetched.corner[k];
  ScreenBoxes boxes{};
  TileBoxes tiles;
  SetupCandidates wide;
  wide.count = 0;
  for (size_t i = first; i < last; i += kFetched) {
    const size_t count = std::min(last - i, kFetched);
    for (size_t next = i + kFetchAhead; next < std::min(i + kFetchAhead + kFetched, last); ++next) {
      const glm::uvec3& c = mesh.triangles[next];
      for (int v = 0; v < 3; ++v) hwy::Prefetch(&mesh.positions[c[v]]);
    }
    FetchCorners(mesh, i, count, fetched);
    const std::uint32_t seen = bounded
                                   ? BoundTriangles<kFetched>(view, WholeFrame(view), corner, count, boxes)
                                   : BoundNowhere(view, corner, count, boxes);
    if (seen == 0) continue;
    FindTiles(boxes, tile_columns, tiles);
    if (view.exact_only) tiles.one = tiles.few = 0;
    for (std::uint32_t bits = seen & tiles.one; bits != 0; bits &= bits - 1) {
      const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
      to.lists.add(tiles.tile[lane],
                   {static_cast<std::uint32_t>(i + lane), boxes.nearest[lane], tiles.box[lane]});
    }
    for (std::uint32_t bits = seen & tiles.few & ~tiles.one; bits != 0; bits &= bits - 1) {
      const size_t lane = hwy::Num0BitsBelowLS1Bit_Nonzero32(bits);
      AddToTiles(boxes, lane, static_cast<std::uint32_t>(i + lane), tile_columns, to.lists);
    }
    AddCandidates(corner, boxes, seen & ~tiles.few, i, wide);
    if (wide.count >= kFetched) {
      SetUpWide(view, wide, to.wide);
      wide.count = 0;
    }
  }
  SetUpWide(view, wide, to.wide);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
