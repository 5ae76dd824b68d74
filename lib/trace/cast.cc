#include "plumb/cast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "frame/frame_check.h"
#include "pixels/projection.h"
#include "pixels/tile.h"
#include "plumb/error.h"
#include "scene/pixel_direction.h"
#include "tiles/tile_kernel.h"
#include "trace/structure_data.h"

namespace plumb {
namespace {

// Rays of a block of pixels are cast together, square by square: a square's go through the tree as one
// (trace/packet-inl.h), and neighbouring squares' visit the same nodes while these are in the cache.
constexpr int kBlockSide = 16;
constexpr int kSquareSide = 4;

// Calls visit(x, y) for the block's pixels that the camera has, in the order of their rays.
template <typename Visit>
void for_pixels(const Camera& camera, int x0, int y0, const Visit& visit) {
  const int x1 = std::min(x0 + kBlockSide, camera.width);
  const int y1 = std::min(y0 + kBlockSide, camera.height);
  for (int square_y = y0; square_y < y1; square_y += kSquareSide) {
    for (int square_x = x0; square_x < x1; square_x += kSquareSide) {
      for (int y = square_y; y < std::min(square_y + kSquareSide, y1); ++y) {
        for (int x = square_x; x < std::min(square_x + kSquareSide, x1); ++x) visit(x, y);
      }
    }
  }
}

void cast_block(const Structure& structure, const Camera& camera, int x0, int y0, Frame& frame) {
  std::array<Ray, kBlockSide * kBlockSide> rays;
  std::array<Hit, kBlockSide * kBlockSide> hits;
  std::size_t count = 0;
  // What Camera::ray makes, with the mode set once.
  detail::with_default_fp_mode([&] {
    for_pixels(camera, x0, y0, [&](int x, int y) {
      Ray& ray = rays[count++];
      ray.origin = camera.eye;
      ray.direction = detail::pixel_direction(camera, x, y);
    });
  });
  structure.closest(std::span<const Ray>(rays.data(), count), std::span<Hit>(hits.data(), count));
  const Hit* hit = hits.data();
  for_pixels(camera, x0, y0, [&](int x, int y) {
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
    frame.depth[pixel] = hit->t;
    frame.id[pixel] = hit->id;
    ++hit;
  });
}

void cast_rays(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options) {
  const auto columns = static_cast<std::size_t>((camera.width + kBlockSide - 1) / kBlockSide);
  const auto rows = static_cast<std::size_t>((camera.height + kBlockSide - 1) / kBlockSide);
  detail::Progress progress(options.progress, columns * rows);
  detail::parallel_for(columns * rows, options.threads, [&](std::size_t block) {
    if (progress.cancelled()) return;
    const int x0 = static_cast<int>(block % columns) * kBlockSide;
    const int y0 = static_cast<int>(block / columns) * kBlockSide;
    cast_block(structure, camera, x0, y0, frame);
    progress.add(1);
  });
  progress.throw_if_cancelled();
}

// False, with nothing done, where tiles cannot be culled.
bool cast_tiles(const detail::StructureData& data, const Camera& camera, Frame& frame,
                const CastOptions& options) {
  const glm::vec3& eye = camera.eye;
  if (!(std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z))) return false;
  const detail::TileCaster caster = data.tiles_for(data.simd);
  const detail::Projection projection(camera);
  const detail::FrameFrustum frustum(projection, caster.greatest(data.structure.get()));
  if (!frustum.usable) return false;
  const auto columns = static_cast<std::size_t>((camera.width - 1) / detail::kTilePx + 1);
  const auto rows = static_cast<std::size_t>((camera.height - 1) / detail::kTilePx + 1);
  detail::Progress progress(options.progress, columns * rows);
  detail::parallel_for(columns * rows, options.threads, [&](std::size_t tile) {
    if (progress.cancelled()) return;
    const detail::TileView view{camera, projection.exact_only,
                                static_cast<int>(tile % columns) * detail::kTilePx,
                                static_cast<int>(tile / columns) * detail::kTilePx};
    caster.cast(data.structure.get(), frustum, view, frame);
    progress.add(1);
  });
  progress.throw_if_cancelled();
  return true;
}

void cast_frame(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options) {
  detail::check_frame(frame, camera);
  const detail::StructureData& data = structure.data();
  if (options.method == CastMethod::Tiles && data.tiles_for == nullptr)
    throw Error("plumb: CastMethod::Tiles takes a Bvh of width 4 or 8 with Arithmetic::Exact, not compact");
  const bool tiles = options.method != CastMethod::Rays && data.tiles_for != nullptr;
  if (tiles && detail::with_default_fp_mode([&] { return cast_tiles(data, camera, frame, options); })) return;
  cast_rays(structure, camera, frame, options);
}

}  // namespace

void cast(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options) {
  if (options.simd == Simd::Auto) {
    cast_frame(structure, camera, frame, options);
  } else {
    cast_frame(structure.with_simd(options.simd), camera, frame, options);
  }
}

}  // namespace plumb
