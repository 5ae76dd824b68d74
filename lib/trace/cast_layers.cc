#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "frame/frame_check.h"
#include "plumb/layers.h"
#include "plumb/ray.h"

namespace plumb {
namespace {

// Pixels of a square are cast by one thread, one after the other, so that they visit the same nodes.
constexpr int kSide = 16;

void cast_square(const Structure& structure, const Camera& camera, int x0, int y0, LayeredFrame& frame) {
  const auto layers = static_cast<std::size_t>(frame.layers);
  std::vector<Hit> hits(layers);
  for (int y = y0; y < std::min(y0 + kSide, camera.height); ++y) {
    for (int x = x0; x < std::min(x0 + kSide, camera.width); ++x) {
      structure.first(camera.ray(x, y), hits);
      const std::size_t pixel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
      for (std::size_t k = 0; k < layers; ++k) {
        frame.depth[pixel * layers + k] = hits[k].t;
        frame.id[pixel * layers + k] = hits[k].id;
      }
    }
  }
}

}  // namespace

void cast_layers(const Structure& structure, const Camera& camera, LayeredFrame& frame,
                 const CastOptions& options) {
  detail::check_frame(frame, camera);
  const Structure cast_through = options.simd == Simd::Auto ? structure : structure.with_simd(options.simd);
  const auto columns = static_cast<std::size_t>((camera.width - 1) / kSide) + 1;
  const auto rows = static_cast<std::size_t>((camera.height - 1) / kSide) + 1;
  detail::Progress progress(options.progress, columns * rows);
  detail::parallel_for(columns * rows, options.threads, [&](std::size_t square) {
    if (progress.cancelled()) return;
    cast_square(cast_through, camera, static_cast<int>(square % columns) * kSide,
                static_cast<int>(square / columns) * kSide, frame);
    progress.add(1);
  });
  progress.throw_if_cancelled();
}

}  // namespace plumb
