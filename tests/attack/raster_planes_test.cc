// Attacks the rasterizer's planes (pixels/triangle_setup-inl.h, pixels/tile_planes-inl.h): a search for
// cameras, triangles and pixels whose edge functions and 1/t are as far from those of the pixel's float ray
// as possible. Each Highway target by itself.

#include "raster/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "attack/raster_planes_test.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "raster/binning-inl.h"
#include "raster/tile_draw-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

// The planes of the mesh's one triangle at a pixel, and their bounds: as values over the frame, and about the
// pixel's tile. False where it is left out, lies elsewhere, or its side is open.
bool PlaneValues(const Projection& view, MeshView mesh, int x, int y, double screen[2][4],
                 double tile[2][4]) {
  alignas(64) float row[9][kFetched] = {};
  const float* corner[9];
  for (int k = 0; k < 9; ++k) {
    row[k][0] = mesh.positions[static_cast<size_t>(k / 3)][k % 3];
    corner[k] = row[k];
  }
  ScreenBoxes boxes{};
  const std::uint32_t seen = BoundTriangles<kFetched>(view, WholeFrame(view), corner, 1, boxes);
  if (seen == 0 || x < boxes.x0[0] || x > boxes.x1[0] || y < boxes.y0[0] || y > boxes.y1[0]) return false;
  SetupCandidates candidates{};
  AddCandidates(corner, boxes, seen, 0, candidates);
  SetupLanes lanes{};
  std::uint32_t side_open = 0, uncovered = 0;
  SetUpLanes(view, candidates, 0, lanes, side_open, uncovered);
  if (((side_open | uncovered) & 1) != 0) return false;
  for (int i = 0; i < 4; ++i) {
    screen[0][i] = lanes.c[i][0] + lanes.a[i][0] * x + lanes.b[i][0] * y;
    screen[1][i] = double{lanes.error[i][0]};
  }
  const int tile_x = x / kTilePx * kTilePx, tile_y = y / kTilePx * kTilePx;
  TileTriangle placed[1];
  if ((x + y) % 2 == 0) {  // as a vector of triangles, or as a wide one by itself
    const SetupTag d;
    PlaceLanes(hn::Set(d, tile_x), hn::Set(d, tile_y), lanes);
    StorePlaced(lanes, 0, candidates, 0, placed[0]);
  } else {
    std::vector<ScreenTriangle> wide;
    SetUpWide(view, candidates, wide);
    if (wide.size() != 1) return false;
    PlaceTriangle(wide[0], tile_x, tile_y, placed[0]);
  }
  const int block = (y - tile_y) / kBlockPx * kTileBlocks + (x - tile_x) / kBlockPx;
  const int pixel = (y - tile_y) % kBlockPx * kBlockPx + (x - tile_x) % kBlockPx;
  const hn::CappedTag<float, 16> d;
  for (int i = 0; i < 4; ++i) {
    HWY_ALIGN float values[16];
    for (size_t lane = 0; lane < 16; lane += hn::Lanes(d)) {
      auto at_x = hn::Zero(d), at_y = hn::Zero(d);
      PixelCentres(d, block, lane, at_x, at_y);
      hn::Store(PlaneAt(d, placed[0], i, at_x, at_y), d, values + lane);
    }
    tile[0][i] = double{values[static_cast<size_t>(pixel)]};
    tile[1][i] = double{placed[0].error[i]};
  }
  return true;
}

// What a wide triangle's tile and block say of their pixel (x, y), all being hidden whose 1/t is below
// `hidden_below`: whether it may be seen, by the tile, tested with the others of its square, and by the
// block; whether the block is covered in full; and the ends of 1/t in the block. False where the triangle is
// not drawn, its side is open, or its box leaves the pixel out.
bool ClaimsAt(const Projection& view, MeshView mesh, int x, int y, float hidden_below, bool& tile_open,
              bool& block_open, bool& block_full, float ends[2]) {
  BinnedTriangles binned;
  alignas(64) float row[9][kFetched] = {};
  const float* corner[9];
  for (int k = 0; k < 9; ++k) {
    row[k][0] = mesh.positions[static_cast<size_t>(k / 3)][k % 3];
    corner[k] = row[k];
  }
  ScreenBoxes boxes{};
  const std::uint32_t seen = BoundTriangles<kFetched>(view, WholeFrame(view), corner, 1, boxes);
  SetupCandidates candidates{};
  AddCandidates(corner, boxes, seen, 0, candidates);
  SetUpWide(view, candidates, binned.wide);
  if (binned.wide.size() != 1) return false;
  const ScreenTriangle& triangle = binned.wide[0];
  if (triangle.side_open || x < triangle.x0 || x > triangle.x1 || y < triangle.y0 || y > triangle.y1)
    return false;
  const int tile_x = x / kTilePx * kTilePx, tile_y = y / kTilePx * kTilePx;
  const SquareGrid grid(view.width, view.height, 8 * kTilePx);
  SquareLists lists;
  lists.add(static_cast<std::uint32_t>(grid.at(x, y)), {&triangle, triangle.nearest});
  lists.sort();
  lists.sort_by_depth(grid);
  const SortedList list = lists.sorted_list(grid, tile_x, tile_y);
  tile_open = SeenOfGroup(list.groups[0], list.x, list.y, std::max(hidden_below, 0.0f)) == 1;

  TileTriangle placed[1];
  PlaceTriangle(triangle, tile_x, tile_y, placed[0]);
  HWY_ALIGN float grow[4];
  Grow(placed[0], 1.5f, grow);
  const hn::CappedTag<float, 16> d;
  HWY_ALIGN float hidden[kTileBlocks * kTileBlocks], low[16], high[16];
  std::fill(std::begin(hidden), std::end(hidden), hidden_below);
  const int block_row = (y - tile_y) / kBlockPx, block_column = (x - tile_x) / kBlockPx;
  const size_t block = static_cast<size_t>(block_row) * kTileBlocks + static_cast<size_t>(block_column);
  const size_t first = block / hn::Lanes(d) * hn::Lanes(d);
  auto open = hn::FirstN(d, 0), full = open;
  auto least = hn::Zero(d), greatest = least;
  TestBlocks(d, placed[0], grow, first, hidden, open, full, least, greatest);
  hn::Store(least, d, low);
  hn::Store(greatest, d, high);
  block_open = (MaskBits(d, open) >> (block - first) & 1) != 0;
  block_full = (MaskBits(d, full) >> (block - first) & 1) != 0;
  ends[0] = low[block - first];
  ends[1] = high[block - first];
  return true;
}

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <doctest/doctest.h>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "attack/climb.h"
#include "attack/exact_values.h"
#include "base/simd_dispatch.h"
#include "support/effort.h"

namespace plumb::detail {
namespace {

HWY_EXPORT(PlaneValues);
HWY_EXPORT(ClaimsAt);

using attack::ExactValues;
using attack::Input;
using hard::Random;

// What is exact of a triangle seen by a pixel: its four planes.
struct ExactPlanes {
  mpq_class value[4];
  bool usable = false;
};

double to_double(const mpq_class& value) { return value.get_d(); }

// (p x q) . r in full, for p and q seen from the eye.
mpq_class triple(const glm::vec3& eye, const glm::vec3& p, const glm::vec3& q, const glm::dvec3& r) {
  mpq_class a[3], b[3];
  for (int i = 0; i < 3; ++i) {
    a[i] = mpq_class(double{p[i]}) - mpq_class(double{eye[i]});
    b[i] = mpq_class(double{q[i]}) - mpq_class(double{eye[i]});
  }
  return (a[1] * b[2] - a[2] * b[1]) * mpq_class(r.x) + (a[2] * b[0] - a[0] * b[2]) * mpq_class(r.y) +
         (a[0] * b[1] - a[1] * b[0]) * mpq_class(r.z);
}

ExactPlanes exact_planes(const Camera& camera, const Triangle& triangle, int x, int y) {
  const ExactValues exact(camera.eye, camera.ray(x, y).direction, triangle);
  ExactPlanes planes;
  if (exact.t_num == 0) return planes;
  const glm::vec3 corner[3] = {triangle.v0, triangle.v1, triangle.v2};
  const mpq_class scale(mpz_class(1), mpz_class(1) << attack::kScaleBits);
  for (int i = 0; i < 3; ++i) {
    const glm::vec3& p = corner[i];
    const glm::vec3& q = corner[(i + 1) % 3];
    const mpq_class unit =
        abs(triple(camera.eye, p, q, camera.du)) + abs(triple(camera.eye, p, q, camera.dv));
    if (unit == 0) return planes;
    planes.value[i] = mpq_class(exact.edge[i]) * scale / unit;
    if (exact.t_num < 0) planes.value[i] = -planes.value[i];
  }
  planes.value[3] = mpq_class(exact.den, 1) / mpq_class(exact.t_num, 1);
  planes.usable = true;
  return planes;
}

// |computed - exact| / bound, or -1 where the bound says nothing.
double share(double computed, const mpq_class& exact, double bound) {
  if (!(bound < std::numeric_limits<double>::infinity())) return -1.0;
  const mpq_class error = abs(mpq_class(computed) - exact);
  return to_double(error / mpq_class(bound));
}

struct Shares {
  double screen_edge = -1.0, screen_inverse = -1.0, tile_edge = -1.0, tile_inverse = -1.0;
};

struct Target {
  Simd simd;
  Camera camera;
  int x, y;
};

Shares shares_of(const Target& target, const Input& input) {
  const Projection view(target.camera);
  const Triangle triangle = input.triangle();
  const TriangleMesh mesh{{triangle.v0, triangle.v1, triangle.v2}, {{0, 1, 2}}};
  double screen[2][4], tile[2][4];
  Shares shares;
  if (view.exact_only ||
      !PLUMB_DISPATCH(PlaneValues, target.simd)(view, mesh, target.x, target.y, screen, tile))
    return shares;
  const ExactPlanes exact = exact_planes(target.camera, triangle, target.x, target.y);
  if (!exact.usable) return shares;
  for (int i = 0; i < 3; ++i) {
    shares.screen_edge = std::max(shares.screen_edge, share(screen[0][i], exact.value[i], screen[1][i]));
    shares.tile_edge = std::max(shares.tile_edge, share(tile[0][i], exact.value[i], tile[1][i]));
  }
  // 1/t has a relative error besides: docs in pixels/screen_triangle.h.
  const double inverse = std::fabs(to_double(exact.value[3]));
  shares.screen_inverse =
      share(screen[0][3], exact.value[3], screen[1][3] + ScreenTriangle::kDepthRelative * inverse);
  shares.tile_inverse = share(tile[0][3], exact.value[3], tile[1][3]);
  return shares;
}

Camera random_camera(Random& random) {
  const glm::vec3 eye = random.unit3() * 4.0f;
  const glm::vec3 target = random.unit3();
  const double degrees = random.one_in(2) ? 50.0 : 0.5;
  const int width = random.between(1, 2000), height = random.between(1, 2000);
  return Camera::look_at(eye, target, {0.01f, 1.0f, 0.02f}, degrees, width, height);
}

// Corners on the rays of pixels around the one looked at, mostly: near it or all over the frame.
Input random_triangle(Random& random, const Target& target) {
  Input input{};
  const int spread = random.one_in(2) ? 6 : std::max(target.camera.width, target.camera.height);
  for (std::size_t v = 0; v < 3; ++v) {
    const int x = target.x + random.between(-spread, spread), y = target.y + random.between(-spread, spread);
    const Ray ray = target.camera.ray(x, y);
    const float fraction = 1.5f + 0.5f * random.unit();
    const float depth = std::ldexp(fraction, random.between(-4, 10));
    for (int axis = 0; axis < 3; ++axis)
      input.value[6 + 3 * v + static_cast<std::size_t>(axis)] =
          ray.origin[axis] + depth * ray.direction[axis];
  }
  return input;
}

double tightest(Simd simd, std::uint64_t seed, double Shares::*which) {
  Random random(seed);
  double greatest = -1.0;
  for (int start = 0; start < hard::effort(40); ++start) {
    Target target{simd, random_camera(random), 0, 0};
    target.x = random.between(0, target.camera.width - 1);
    target.y = random.between(0, target.camera.height - 1);
    const auto draw = [&](Random& r) { return random_triangle(r, target); };
    const auto objective = [&](const Input& input) {
      for (const float f : input.value) {
        if (!std::isfinite(f)) return -1.0;
      }
      return shares_of(target, input).*which;
    };
    greatest = std::max(greatest, attack::climb(random, 1, hard::effort(400), draw, objective));
  }
  return greatest;
}

// The greatest float that is no more than the number.
float rounded_down(const mpq_class& value) {
  auto f = static_cast<float>(to_double(value));
  while (mpq_class(double{f}) > value) f = std::nextafter(f, -std::numeric_limits<float>::infinity());
  return f;
}

// Holds the claims of a triangle's tile and block against what is exact at the pixel, which it may hide
// itself least of all. Counts what was claimed of pixels that it covers.
void hold_claims(const Target& target, const Input& input, int claimed[3]) {
  const Projection view(target.camera);
  const Triangle triangle = input.triangle();
  const ExactPlanes exact = exact_planes(target.camera, triangle, target.x, target.y);
  if (view.exact_only || !exact.usable) return;
  if (!(abs(exact.value[3]) < mpq_class(0x1p100))) return;
  const TriangleMesh mesh{{triangle.v0, triangle.v1, triangle.v2}, {{0, 1, 2}}};
  bool tile_open = false, block_open = false, block_full = false;
  float ends[2] = {};
  if (!PLUMB_DISPATCH(ClaimsAt, target.simd)(view, mesh, target.x, target.y, rounded_down(exact.value[3]),
                                             tile_open, block_open, block_full, ends))
    return;
  const bool covered = exact.value[0] > 0 && exact.value[1] > 0 && exact.value[2] > 0 && exact.value[3] > 0;
  if (covered) {
    ++claimed[0];
    CHECK(tile_open);
    CHECK(block_open);
  }
  if (block_full) {
    ++claimed[1];
    CHECK(covered);
  }
  if (std::isfinite(ends[0])) {
    ++claimed[2];
    CHECK(mpq_class(double{ends[0]}) <= exact.value[3]);
    CHECK(mpq_class(double{ends[1]}) >= exact.value[3]);
  }
}

}  // namespace

TEST_SUITE("attack: the rasterizer's planes") {
  TEST_CASE("the bounds hold on every target, and the search comes near them") {
    struct {
      std::string name;
      double Shares::*which;
      double found;  // what the search is known to reach: less says that the bound grew or it got worse
    } const bounds[] = {{"edge functions over the frame", &Shares::screen_edge, 0.6},
                        {"1/t over the frame", &Shares::screen_inverse, 0.5},
                        {"edge functions about a tile", &Shares::tile_edge, 0.5},
                        {"1/t about a tile", &Shares::tile_inverse, 0.45}};
    for (const Simd simd : simd_targets()) {
      std::uint64_t seed = 1;
      for (const auto& bound : bounds) {
        const double greatest = tightest(simd, ++seed, bound.which);
        MESSAGE(std::string(simd_name(simd))
                << ", " << bound.name << ": the greatest error found is " << greatest << " of its bound");
        CHECK(greatest <= 1.0);
        CHECK(greatest > bound.found / hard::kEffortDivisor);
      }
    }
  }

  TEST_CASE("what tiles and blocks claim of a triangle holds at their pixels") {
    for (const Simd simd : simd_targets()) {
      Random random(11);
      int claimed[3] = {};
      for (int i = 0; i < hard::effort(6000); ++i) {
        Target target{simd, random_camera(random), 0, 0};
        target.x = random.between(0, target.camera.width - 1);
        target.y = random.between(0, target.camera.height - 1);
        const Input input = random_triangle(random, target);
        if (std::all_of(std::begin(input.value), std::end(input.value),
                        [](float f) { return std::isfinite(f); }))
          hold_claims(target, input, claimed);
      }
      for (const int count : claimed) CHECK(count > hard::effort(200));
    }
  }
}

}  // namespace plumb::detail
#endif
