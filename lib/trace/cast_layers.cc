#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "frame/frame_check.h"
#include "plumb/layers.h"
#include "plumb/ray.h"

namespace plumb {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// Pixels that a thread takes at a time.
constexpr int kRun = 64;

// A ray whose neighbour's last entry lies at t asks up to this much farther.
constexpr float kRoom = 1.25f;

// The first hits of one ray after another.
class FirstHits {
 public:
  FirstHits(const Structure& structure, std::size_t most) : structure_(structure), most_(most) {}

  // At most so many as are wanted, in (t, id) order; good until the next call.
  const std::vector<Hit>& of(Ray ray) {
    // Hits up to a limit are the first of all where there are enough of them.
    ray.tmax = limit_;
    structure_.all(ray, hits_);
    if (hits_.size() < most_ && ray.tmax < kInfinity) {
      ray.tmax = kInfinity;
      structure_.all(ray, hits_);
    }
    limit_ = hits_.size() < most_ ? kInfinity : hits_[most_ - 1].t * kRoom;
    if (hits_.size() > most_) hits_.resize(most_);
    return hits_;
  }

 private:
  const Structure& structure_;
  std::size_t most_;
  float limit_ = kInfinity;
  std::vector<Hit> hits_;
};

// Pixels [x0, x1) of a row.
void cast_run(const Structure& structure, const Camera& camera, int x0, int x1, int y, LayeredFrame& frame) {
  const auto layers = static_cast<std::size_t>(frame.layers);
  FirstHits first(structure, layers);
  for (int x = x0; x < x1; ++x) {
    const std::vector<Hit>& hits = first.of(camera.ray(x, y));
    const std::size_t pixel =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(x);
    for (std::size_t k = 0; k < layers; ++k) {
      const Hit hit = k < hits.size() ? hits[k] : Hit{kInfinity, kNone};
      frame.depth[pixel * layers + k] = hit.t;
      frame.id[pixel * layers + k] = hit.id;
    }
  }
}

}  // namespace

void cast_layers(const Structure& structure, const Camera& camera, LayeredFrame& frame,
                 const CastOptions& options) {
  detail::check_frame(frame, camera);
  const Structure cast_through = options.simd == Simd::Auto ? structure : structure.with_simd(options.simd);
  const auto runs = static_cast<std::size_t>(camera.width - 1) / kRun + 1;
  const std::size_t pieces = runs * static_cast<std::size_t>(camera.height);
  detail::Progress progress(options.progress, pieces);
  detail::parallel_for(pieces, options.threads, [&](std::size_t piece) {
    if (progress.cancelled()) return;
    const int x0 = static_cast<int>(piece % runs) * kRun;
    const int y = static_cast<int>(piece / runs);
    cast_run(cast_through, camera, x0, std::min(x0 + kRun, camera.width), y, frame);
    progress.add(1);
  });
  progress.throw_if_cancelled();
}

}  // namespace plumb
