#include "plumb/cast.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

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

// A frame to be cast, piece by piece: squares of pixels, or tiles where the structure is walked for those.
class FrameJob {
 public:
  FrameJob(const Structure& structure, const Camera& camera, Frame& frame, CastMethod method)
      : structure_(structure), camera_(camera), frame_(frame) {
    const detail::StructureData& data = structure.data();
    if (method != CastMethod::Rays && data.tiles_for != nullptr) prepare_tiles(data);
    const std::size_t side = caster_ ? detail::kTilePx : kBlockSide;
    columns_ = static_cast<std::size_t>(camera.width - 1) / side + 1;
    pieces_ = columns_ * (static_cast<std::size_t>(camera.height - 1) / side + 1);
  }

  std::size_t pieces() const { return pieces_; }

  void cast(std::size_t piece) const {
    const int column = static_cast<int>(piece % columns_), row = static_cast<int>(piece / columns_);
    if (!caster_) {
      cast_block(structure_, camera_, column * kBlockSide, row * kBlockSide, frame_);
      return;
    }
    const detail::TileView view{camera_, projection_->exact_only, column * detail::kTilePx,
                                row * detail::kTilePx};
    caster_->cast(structure_.data().structure.get(), *frustum_, view, frame_);
  }

 private:
  // Leaves rays to be cast where tiles cannot be culled.
  void prepare_tiles(const detail::StructureData& data) {
    const glm::vec3& eye = camera_.eye;
    if (!(std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z))) return;
    detail::with_default_fp_mode([&] {
      const detail::TileCaster caster = data.tiles_for(data.simd);
      projection_.emplace(camera_);
      frustum_.emplace(*projection_, caster.greatest(data.structure.get()));
      if (frustum_->usable) caster_ = caster;
    });
  }

  const Structure& structure_;
  const Camera& camera_;
  Frame& frame_;
  std::optional<detail::Projection> projection_;
  std::optional<detail::FrameFrustum> frustum_;
  std::optional<detail::TileCaster> caster_;
  std::size_t columns_ = 0, pieces_ = 0;
};

void check_method(const Structure& structure, CastMethod method) {
  if (method == CastMethod::Tiles && structure.data().tiles_for == nullptr)
    throw Error("plumb: CastMethod::Tiles takes a Bvh of width 4 or 8 with Arithmetic::Exact, not compact");
}

// The pieces of all frames are one piece of work.
void cast_frames(const Structure& structure, std::span<const Camera> cameras, std::span<Frame> frames,
                 const CastOptions& options) {
  check_method(structure, options.method);
  std::deque<FrameJob> jobs;  // they do not move
  std::vector<std::size_t> first;
  std::size_t pieces = 0;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    jobs.emplace_back(structure, cameras[i], frames[i], options.method);
    first.push_back(pieces);
    pieces += jobs.back().pieces();
  }
  detail::Progress progress(options.progress, pieces);
  detail::parallel_for(pieces, options.threads, [&](std::size_t piece) {
    if (progress.cancelled()) return;
    const auto after = std::upper_bound(first.begin(), first.end(), piece);
    const auto frame = static_cast<std::size_t>(after - first.begin()) - 1;
    jobs[frame].cast(piece - first[frame]);
    progress.add(1);
  });
  progress.throw_if_cancelled();
}

}  // namespace

void cast(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options) {
  detail::check_frame(frame, camera);
  const Structure cast_through = options.simd == Simd::Auto ? structure : structure.with_simd(options.simd);
  cast_frames(cast_through, {&camera, 1}, {&frame, 1}, options);
}

void cast(const Structure& structure, std::span<const Camera> cameras, std::span<Frame> frames,
          const CastOptions& options) {
  detail::check_frames(frames, cameras, "cast");
  const Structure cast_through = options.simd == Simd::Auto ? structure : structure.with_simd(options.simd);
  cast_frames(cast_through, cameras, frames, options);
}

}  // namespace plumb
