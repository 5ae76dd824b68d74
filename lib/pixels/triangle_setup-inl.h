// Sets triangles up for tiles: their planes over the frame, a vector of triangles at a time, in double.
// Included once per Highway target.

#if defined(PLUMB_PIXELS_TRIANGLE_SETUP_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef PLUMB_PIXELS_TRIANGLE_SETUP_INL_H_
#undef PLUMB_PIXELS_TRIANGLE_SETUP_INL_H_
#else
#define PLUMB_PIXELS_TRIANGLE_SETUP_INL_H_
#endif

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "base/mask_bits-inl.h"
#include "base/round-inl.h"
#include "exact/depth-inl.h"
#include "hwy/highway.h"
#include "pixels/projection.h"
#include "pixels/screen_bounds-inl.h"
#include "pixels/screen_triangle.h"
#include "pixels/tile_planes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A vector of triangles on the way: corners seen from the eye, and ScreenTriangle's fields.
struct SetupLanes {
  alignas(64) double corner[9][8];
  alignas(64) double size[3][8];  // |corner|_1
  alignas(64) double turn[8];
  alignas(64) double plane[6][8];  // DrawnTriangles' normal and bounds

  alignas(64) double a[4][8], b[4][8], c[4][8];
  alignas(64) float error[4][8];

  // The same about a tile.
  alignas(64) float tile_a[4][8], tile_b[4][8], tile_c[4][8], tile_error[4][8];
  alignas(64) float edge_error[8];
};

// n.D over the frame times `scale` is the plane; `error` is its bound before scaling.
HWY_INLINE void StorePlane(const Projection& view, int plane, SetupVector nx, SetupVector ny, SetupVector nz,
                           SetupVector error, SetupVector scale, SetupLanes& lanes) {
  const SetupTag d;
  const hn::Rebind<float, SetupTag> df;
  hn::Store(hn::Mul(Dot(nx, ny, nz, view.du), scale), d, lanes.a[plane]);
  hn::Store(hn::Mul(Dot(nx, ny, nz, view.dv), scale), d, lanes.b[plane]);
  hn::Store(hn::Mul(Dot(nx, ny, nz, view.c0), scale), d, lanes.c[plane]);
  // Rounded up when it becomes a float.
  const SetupVector scaled = hn::Mul(error, hn::Abs(scale));
  const SetupVector padded = hn::MulAdd(scaled, hn::Set(d, 1.0 + 0x1p-20), hn::Set(d, 0x1p-140));
  hn::Store(RoundToFloat(df, padded), df, lanes.error[plane]);
}

// How far n.d can be from n.D for the ray d of a pixel.
HWY_INLINE SetupVector RayRounding(const Projection& view, SetupVector nx, SetupVector ny, SetupVector nz) {
  const SetupTag d;
  return hn::Mul(Dot(hn::Abs(nx), hn::Abs(ny), hn::Abs(nz), view.offset), hn::Set(d, 1.001));
}

// With p, q the triangle's vertices seen from the eye (each off by u of itself), n = p x q, and the
// edge function E = d.n at a pixel's float ray d:
//   n:       a component by (2 for p and q, 2 for product and difference) 4 u (|p_j q_k| + |p_k q_j|)
//   n.du, n.dv, n.c0: 3 u for the dot product, 2 u for scaling
//   c + a x + b y: 4 u
// each times at most G |p|_1 |q|_1, so 13 u G |p|_1 |q|_1 (20 below: second order, and a few more sums of
// DropUncovered), and for the rounding of the ray: sum of offset_k |n_k|.
HWY_INLINE void SetUpEdge(const Projection& view, int edge, SetupLanes& lanes) {
  const SetupTag d;
  const int next = (edge + 1) % 3;
  const auto load = [&](int v, int axis) HWY_ATTR { return hn::Load(d, lanes.corner[3 * v + axis]); };
  const SetupVector px = load(edge, 0), py = load(edge, 1), pz = load(edge, 2);
  const SetupVector qx = load(next, 0), qy = load(next, 1), qz = load(next, 2);
  const SetupVector nx = hn::MulSub(py, qz, hn::Mul(pz, qy));
  const SetupVector ny = hn::MulSub(pz, qx, hn::Mul(px, qz));
  const SetupVector nz = hn::MulSub(px, qy, hn::Mul(py, qx));
  const SetupVector sizes = hn::Mul(hn::Load(d, lanes.size[edge]), hn::Load(d, lanes.size[next]));
  const SetupVector error =
      hn::MulAdd(sizes, hn::Set(d, 20.0 * kSetupU * view.greatest), RayRounding(view, nx, ny, nz));
  // One unit to a pixel; where no step changes the function, one unit its value. What is left, 1/0, ends in
  // infinities and NaNs, which every later test takes for "not certain".
  const SetupVector slope = hn::Add(hn::Abs(Dot(nx, ny, nz, view.du)), hn::Abs(Dot(nx, ny, nz, view.dv)));
  const SetupVector unit =
      hn::IfThenElse(hn::Gt(slope, hn::Zero(d)), slope, hn::Abs(Dot(nx, ny, nz, view.c0)));
  StorePlane(view, edge, nx, ny, nz, error, hn::Div(hn::Load(d, lanes.turn), unit), lanes);
}

// The depth's plane. Two words of bits: triangles whose side is open, and those of which no pixel sees
// anything, two vertices being equal (one edge function is exactly zero then, and its displaced sign too).
//
// The values and bounds of T = N.a and den = N.d are those of exact/depth-inl.h: they hold with and without
// fused operations. 1/t = den / T as a plane: 4 u for N, 3 u for the dot product, 2 u
// for scaling, 4 u for c + a x + b y, each times G L^2 (20 below), and the rounding of the ray; and T's error
// and the division, relative.
HWY_INLINE void SetUpDepth(const Projection& view, SetupLanes& lanes, const float* const corner[9],
                           std::uint32_t& side_open, std::uint32_t& flat) {
  const SetupTag d;
  const hn::Rebind<float, SetupTag> df;
  const auto load = [&](int v, int axis)
                        HWY_ATTR { return hn::PromoteTo(d, hn::Load(df, corner[3 * v + axis])); };
  const auto side = [&](int from, int to, int axis)
                        HWY_ATTR { return hn::Sub(load(to, axis), load(from, axis)); };
  const auto size = [&](int from, int to)
                        HWY_ATTR { return Norm1(side(from, to, 0), side(from, to, 1), side(from, to, 2)); };
  flat = MaskBits(d, hn::Eq(hn::Min(size(0, 1), hn::Min(size(0, 2), size(1, 2))), hn::Zero(d)));

  const double eye[3] = {view.eye.x, view.eye.y, view.eye.z};
  SetupVector nx, ny, nz, t_num, t_error, den_factor;
  TrianglePlane(
      d, [&](int k) HWY_ATTR { return hn::Set(d, eye[k]); },
      [&](int k) HWY_ATTR { return load(k / 3, k % 3); }, nx, ny, nz, t_num, t_error, den_factor);
  hn::Store(nx, d, lanes.plane[0]);
  hn::Store(ny, d, lanes.plane[1]);
  hn::Store(nz, d, lanes.plane[2]);
  hn::Store(t_num, d, lanes.plane[3]);
  SetupVector bound_a, bound_b;
  PlaneBounds(d, t_num, t_error, den_factor, 3.01 * view.greatest, bound_a, bound_b);
  hn::Store(bound_a, d, lanes.plane[4]);
  hn::Store(bound_b, d, lanes.plane[5]);
  const SetupVector inverse = hn::Div(hn::Set(d, 1.0), t_num);
  const SetupVector relative = hn::Mul(t_error, hn::Abs(inverse));

  // Seen in front, t = T / den > 0: the edge functions have den's sign, which is T's.
  const auto sided = hn::Lt(relative, hn::Set(d, 0x1p-10));
  side_open = MaskBits(d, hn::Not(sided));
  const SetupVector one = hn::Set(d, 1.0);
  hn::Store(hn::IfThenElse(hn::And(sided, hn::Lt(t_num, hn::Zero(d))), hn::Neg(one), one), d, lanes.turn);

  // den_factor is at least 7.2 u L^2 but for its own roundings.
  const SetupVector den_error =
      hn::MulAdd(den_factor, hn::Set(d, 2.8 * view.greatest), RayRounding(view, nx, ny, nz));
  static_assert(ScreenTriangle::kDepthRelative == 0x1p-26);
  const SetupVector error = hn::IfThenElse(hn::Lt(relative, hn::Set(d, 0x1p-27)),
                                           hn::Mul(den_error, hn::Set(d, 1.01)), hn::Set(d, kDoubleInfinity));
  StorePlane(view, 3, nx, ny, nz, error, inverse, lanes);
}

// A bit for each triangle whose box is at most two pixels wide and high, none of which it covers.
HWY_INLINE std::uint32_t Uncovered(const SetupLanes& lanes, const SetupCandidates& from, size_t first) {
  const SetupTag d;
  const hn::Rebind<float, SetupTag> df;
  const hn::Rebind<std::int32_t, SetupTag> di;
  const auto load = [&](const std::int32_t* side)
                        HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(di, side + first)); };
  const SetupVector x0 = load(from.x0), y0 = load(from.y0);
  const SetupVector width = hn::Sub(load(from.x1), x0), height = hn::Sub(load(from.y1), y0);
  auto missed00 = hn::FirstN(d, 0), missed10 = missed00, missed01 = missed00, missed11 = missed00;
  for (int edge = 0; edge < 3; ++edge) {
    const SetupVector a = hn::Load(d, lanes.a[edge]), b = hn::Load(d, lanes.b[edge]);
    const SetupVector limit = hn::Neg(hn::PromoteTo(d, hn::Load(df, lanes.error[edge])));
    const SetupVector at00 = hn::MulAdd(b, y0, hn::MulAdd(a, x0, hn::Load(d, lanes.c[edge])));
    const SetupVector at10 = hn::MulAdd(a, width, at00);
    missed00 = hn::Or(missed00, hn::Lt(at00, limit));
    missed10 = hn::Or(missed10, hn::Lt(at10, limit));
    missed01 = hn::Or(missed01, hn::Lt(hn::MulAdd(b, height, at00), limit));
    missed11 = hn::Or(missed11, hn::Lt(hn::MulAdd(b, height, at10), limit));
  }
  const SetupVector one = hn::Set(d, 1.0);
  const auto small = hn::And(hn::Le(width, one), hn::Le(height, one));
  const auto missed = hn::And(hn::And(missed00, missed10), hn::And(missed01, missed11));
  return MaskBits(d, hn::And(small, missed));
}

HWY_INLINE void LoadCorners(const Projection& view, const float* const corner[9], SetupLanes& lanes) {
  const SetupTag d;
  const hn::Rebind<float, SetupTag> df;
  const double eye[3] = {view.eye.x, view.eye.y, view.eye.z};
  for (int v = 0; v < 3; ++v) {
    const auto seen = [&](int axis) HWY_ATTR {
      return hn::Sub(hn::PromoteTo(d, hn::Load(df, corner[3 * v + axis])), hn::Set(d, eye[axis]));
    };
    const SetupVector x = seen(0), y = seen(1), z = seen(2);
    hn::Store(x, d, lanes.corner[3 * v]);
    hn::Store(y, d, lanes.corner[3 * v + 1]);
    hn::Store(z, d, lanes.corner[3 * v + 2]);
    hn::Store(Norm1(x, y, z), d, lanes.size[v]);
  }
}

// Sets up the candidates from `first` on: their planes over the frame.
HWY_NOINLINE inline void SetUpLanes(const Projection& view, const SetupCandidates& from, size_t first,
                                    SetupLanes& lanes, std::uint32_t& side_open, std::uint32_t& uncovered) {
  const float* corner[9];
  for (int k = 0; k < 9; ++k) corner[k] = from.corner[k] + first;
  LoadCorners(view, corner, lanes);
  std::uint32_t flat = 0;
  SetUpDepth(view, lanes, corner, side_open, flat);
  for (int edge = 0; edge < 3; ++edge) SetUpEdge(view, edge, lanes);
  uncovered = flat | (Uncovered(lanes, from, first) & ~side_open);
}

// Places the planes about the tiles whose upper left pixels are (tile_x, tile_y).
HWY_INLINE void PlaceLanes(SetupVector tile_x, SetupVector tile_y, SetupLanes& lanes) {
  const SetupTag d;
  const hn::Rebind<float, SetupTag> df;
  const SetupVector half = hn::Set(d, 0.5 * (kTilePx - 1));
  const SetupVector x = hn::Add(tile_x, half), y = hn::Add(tile_y, half);
  for (int k = 0; k < 4; ++k) {
    const SetupVector a = hn::Load(d, lanes.a[k]), b = hn::Load(d, lanes.b[k]);
    auto centre = hn::Zero(df), error = hn::Zero(df);
    PlacePlane(d, a, b, hn::Load(d, lanes.c[k]), hn::PromoteTo(d, hn::Load(df, lanes.error[k])), x, y,
               hn::Set(d, kPlaneRelative[k]), hn::Set(d, kPlaneLimit[k]), centre, error);
    hn::Store(RoundToFloat(df, a), df, lanes.tile_a[k]);
    hn::Store(RoundToFloat(df, b), df, lanes.tile_b[k]);
    hn::Store(centre, df, lanes.tile_c[k]);
    hn::Store(error, df, lanes.tile_error[k]);
  }
  const auto error = [&](int k) HWY_ATTR { return hn::Load(df, lanes.tile_error[k]); };
  hn::Store(hn::Max(error(0), hn::Max(error(1), error(2))), df, lanes.edge_error);
}

// Everything but `place`. The box lies in one tile.
HWY_INLINE void StorePlaced(const SetupLanes& lanes, size_t lane, const SetupCandidates& from, size_t i,
                            TileTriangle& to) {
  for (int k = 0; k < 4; ++k) {
    to.a[k] = lanes.tile_a[k][lane];
    to.b[k] = lanes.tile_b[k][lane];
    to.c[k] = lanes.tile_c[k][lane];
    to.error[k] = lanes.tile_error[k][lane];
  }
  to.edge_error = lanes.edge_error[lane];
  to.nearest = from.nearest[i];
  to.x0 = static_cast<std::uint8_t>(from.x0[i] % kTilePx);
  to.y0 = static_cast<std::uint8_t>(from.y0[i] % kTilePx);
  to.x1 = static_cast<std::uint8_t>(from.x1[i] % kTilePx);
  to.y1 = static_cast<std::uint8_t>(from.y1[i] % kTilePx);
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
