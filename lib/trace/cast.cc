#include "plumb/cast.h"

#include <algorithm>
#include <array>
#include <span>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "frame/frame_check.h"
#include "scene/pixel_direction.h"

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

void cast_frame(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options) {
  detail::check_frame(frame, camera);
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

}  // namespace

void cast(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options) {
  if (options.simd == Simd::Auto) {
    cast_frame(structure, camera, frame, options);
  } else {
    cast_frame(structure.with_simd(options.simd), camera, frame, options);
  }
}

}  // namespace plumb
