#include <cstddef>

#include "base/parallel.h"
#include "frame/frame_check.h"
#include "plumb/raster.h"
#include "raster/frame_drawer.h"

namespace plumb {
namespace {

// Pixels that a thread merges at a time.
constexpr std::size_t kRun = std::size_t{1} << 14;

// Merges runs of pixels by (t, id).
void merge_run(const float* depth, const std::uint32_t* id, std::size_t count, float* to_depth,
               std::uint32_t* to_id) {
  for (std::size_t i = 0; i < count; ++i) {
    const bool nearer = (depth[i] < to_depth[i]) | ((depth[i] == to_depth[i]) & (id[i] < to_id[i]));
    to_depth[i] = nearer ? depth[i] : to_depth[i];
    to_id[i] = nearer ? id[i] : to_id[i];
  }
}

}  // namespace

struct Rasterizer::Impl {
  Impl(const Camera& camera, const RasterOptions& options)
      : drawer(camera, options), drawn(camera.width, camera.height) {}

  detail::FrameDrawer drawer;
  Frame drawn;
  bool empty = true;  // nothing was drawn since it was made or cleared, and `drawn` is anything
};

Rasterizer::Rasterizer(const Camera& camera, const RasterOptions& options)
    : impl_(std::make_unique<Impl>(camera, options)) {}
Rasterizer::~Rasterizer() = default;
Rasterizer::Rasterizer(Rasterizer&&) noexcept = default;
Rasterizer& Rasterizer::operator=(Rasterizer&&) noexcept = default;

void Rasterizer::draw(MeshView mesh, std::uint32_t first_id) {
  impl_->drawer.draw(mesh, first_id, impl_->empty, impl_->drawn);
  impl_->empty = false;
}

void Rasterizer::draw(MeshView mesh) { draw(mesh, impl_->drawer.options().first_id); }

void Rasterizer::resolve(Frame& frame) const {
  detail::check_frame(frame, impl_->drawer.camera());
  if (impl_->empty) return;
  const Frame& drawn = impl_->drawn;
  const std::size_t pixels = drawn.depth.size();
  detail::parallel_for((pixels + kRun - 1) / kRun, impl_->drawer.options().threads, [&](std::size_t run) {
    const std::size_t first = run * kRun;
    merge_run(drawn.depth.data() + first, drawn.id.data() + first, std::min(kRun, pixels - first),
              frame.depth.data() + first, frame.id.data() + first);
  });
}

void Rasterizer::clear() { impl_->empty = true; }

RasterCounts count_raster_tests(MeshView mesh, const Camera& camera, const RasterOptions& options) {
  RasterOptions alone = options;
  alone.threads = 1;
  alone.progress = nullptr;
  detail::FrameDrawer drawer(camera, alone);
  RasterCounts counts;
  counts.triangles = mesh.triangles.size();
  drawer.count(counts);
  Frame frame(camera.width, camera.height);
  drawer.draw(mesh, options.first_id, true, frame);
  return counts;
}

void rasterize(MeshView mesh, const Camera& camera, Frame& frame, const RasterOptions& options) {
  detail::check_frame(frame, camera);
  detail::FrameDrawer(camera, options).draw(mesh, options.first_id, options.overwrite, frame);
}

void rasterize_layers(MeshView mesh, const Camera& camera, LayeredFrame& frame,
                      const RasterOptions& options) {
  detail::check_frame(frame, camera);
  detail::FrameDrawer(camera, options).draw(mesh, options.first_id, options.overwrite, frame);
}

void rasterize(MeshView mesh, std::span<const Camera> cameras, std::span<Frame> frames,
               const RasterOptions& options) {
  detail::check_frames(frames, cameras, "rasterize");
  const auto threads = static_cast<std::size_t>(detail::thread_count(options.threads));
  const bool many = cameras.size() >= threads;
  detail::Progress progress(options.progress, cameras.size());
  detail::parallel_for(cameras.size(), many ? options.threads : 1, [&](std::size_t i) {
    if (progress.cancelled()) return;
    RasterOptions of_one = options;
    of_one.progress = nullptr;
    if (many) of_one.threads = 1;
    rasterize(mesh, cameras[i], frames[i], of_one);
    progress.add(1);
  });
  progress.throw_if_cancelled();
}

}  // namespace plumb
