#include "plumb/cast.h"

#include <algorithm>
#include <array>
#include <span>

#include "base/parallel.h"
#include "frame/frame_check.h"

namespace plumb {
namespace {

// Rays of a block of pixels are cast together: neighbours visit the same nodes while these are in
// the cache.
constexpr int kBlockWidth = 16;
constexpr int kBlockHeight = 16;

void cast_block(const Structure& structure, const Camera& camera, int x0, int y0, Frame& frame) {
  std::array<Ray, kBlockWidth * kBlockHeight> rays;
  std::array<Hit, kBlockWidth * kBlockHeight> hits;
  const int x1 = std::min(x0 + kBlockWidth, camera.width);
  const int y1 = std::min(y0 + kBlockHeight, camera.height);
  std::size_t count = 0;
  for (int y = y0; y < y1; ++y) {
    for (int x = x0; x < x1; ++x) rays[count++] = camera.ray(x, y);
  }
  structure.closest(std::span<const Ray>(rays.data(), count), std::span<Hit>(hits.data(), count));
  const Hit* hit = hits.data();
  for (int y = y0; y < y1; ++y) {
    const std::size_t row = static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width);
    for (int x = x0; x < x1; ++x, ++hit) {
      frame.depth[row + static_cast<std::size_t>(x)] = hit->t;
      frame.id[row + static_cast<std::size_t>(x)] = hit->id;
    }
  }
}

void cast_frame(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options) {
  detail::check_frame(frame, camera);
  const auto columns = static_cast<std::size_t>((camera.width + kBlockWidth - 1) / kBlockWidth);
  const auto rows = static_cast<std::size_t>((camera.height + kBlockHeight - 1) / kBlockHeight);
  detail::Progress progress(options.progress, columns * rows);
  detail::parallel_for(columns * rows, options.threads, [&](std::size_t block) {
    if (progress.cancelled()) return;
    const int x0 = static_cast<int>(block % columns) * kBlockWidth;
    const int y0 = static_cast<int>(block / columns) * kBlockHeight;
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
