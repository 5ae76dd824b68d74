#include "plumb/raster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "base/simd_dispatch.h"
#include "build/mesh_check.h"
#include "exact/intersect.h"
#include "frame/frame_check.h"
#include "pixels/tile.h"
#include "raster/bins.h"
#include "raster/projection.h"
#include "raster/tile.h"

namespace plumb {

using detail::TileGrid;
using detail::TilePixels;

namespace {

// Triangles set up and binned at a time: their records stay within some ten MiB.
constexpr std::size_t kBatch = std::size_t{1} << 16;

TilePixels clear_tile() {
  TilePixels tile;
  std::fill(std::begin(tile.t), std::end(tile.t), std::numeric_limits<float>::infinity());
  std::fill(std::begin(tile.id), std::end(tile.id), kNone);
  return tile;
}

}  // namespace

struct Rasterizer::Impl {
  Impl(const Camera& camera_in, const RasterOptions& options_in)
      : camera(camera_in),
        options(options_in),
        projection(camera),
        grid(camera.width, camera.height),
        draw_tile(detail::draw_tile_kernel(detail::resolve_simd(options.simd))),
        tiles(grid.size(), clear_tile()) {}

  void draw(MeshView mesh, std::uint32_t first_id);
  void draw_batches(MeshView mesh, std::uint32_t first_id);
  void draw_batch(MeshView mesh, std::uint32_t first_id, std::size_t first, std::size_t last,
                  detail::Progress& progress);
  void resolve(Frame& frame) const;

  Camera camera;
  RasterOptions options;
  detail::Projection projection;
  TileGrid grid;
  detail::DrawTile draw_tile;
  std::vector<TilePixels> tiles;
};

void Rasterizer::Impl::draw_batch(MeshView mesh, std::uint32_t first_id, std::size_t first, std::size_t last,
                                  detail::Progress& progress) {
  const detail::Bins bins(projection, camera.eye, grid, mesh, first, last, options.threads);
  const std::vector<std::uint32_t>& touched = bins.touched();
  // The batch's share of the progress, spread over its tiles.
  const std::size_t steps = last - first;
  detail::parallel_for(touched.size(), options.threads, [&](std::size_t i) {
    if (progress.cancelled()) return;
    const std::uint32_t tile = touched[i];
    const int column = static_cast<int>(tile) % grid.columns;
    const int row = static_cast<int>(tile) / grid.columns;
    const detail::TileTask task{camera,   projection.exact_only,    mesh,
                                first_id, column * detail::kTilePx, row * detail::kTilePx};
    draw_tile(task, bins.records(), bins.list(tile), tiles[tile]);
    progress.add(steps * (i + 1) / touched.size() - steps * i / touched.size());
  });
  if (touched.empty()) progress.add(steps);
}

void Rasterizer::Impl::draw(MeshView mesh, std::uint32_t first_id) {
  const glm::vec3& eye = camera.eye;
  if (!(std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z)))
    return;  // no ray sees anything
  if (!options.progress) {
    draw_batches(mesh, first_id);
    return;
  }
  // A call that can be cancelled, or whose callback may throw, must be able to take everything back.
  std::vector<TilePixels> before = tiles;
  try {
    draw_batches(mesh, first_id);
  } catch (...) {
    tiles = std::move(before);
    throw;
  }
}

void Rasterizer::Impl::draw_batches(MeshView mesh, std::uint32_t first_id) {
  detail::Progress progress(options.progress, mesh.triangles.size());
  const std::size_t count = mesh.triangles.size();
  for (std::size_t first = 0; first < count && !progress.cancelled(); first += kBatch) {
    draw_batch(mesh, first_id, first, std::min(first + kBatch, count), progress);
  }
  progress.throw_if_cancelled();
}

void Rasterizer::Impl::resolve(Frame& frame) const {
  const std::size_t width = static_cast<std::size_t>(camera.width);
  detail::parallel_for(grid.size(), options.threads, [&](std::size_t tile) {
    const int x0 = static_cast<int>(tile) % grid.columns * detail::kTilePx;
    const int y0 = static_cast<int>(tile) / grid.columns * detail::kTilePx;
    const int columns = std::min(detail::kTilePx, camera.width - x0);
    const int rows = std::min(detail::kTilePx, camera.height - y0);
    for (int y = 0; y < rows; ++y) {
      const std::size_t row = static_cast<std::size_t>(y0 + y) * width + static_cast<std::size_t>(x0);
      for (int x = 0; x < columns; ++x) {
        const auto offset = static_cast<std::size_t>(detail::tile_offset(x, y));
        const Hit hit{tiles[tile].t[offset], tiles[tile].id[offset]};
        float& depth = frame.depth[row + static_cast<std::size_t>(x)];
        std::uint32_t& id = frame.id[row + static_cast<std::size_t>(x)];
        if (!detail::hit_before(hit.t, hit.id, {depth, id})) continue;
        depth = hit.t;
        id = hit.id;
      }
    }
  });
}

Rasterizer::Rasterizer(const Camera& camera, const RasterOptions& options) {
  detail::check_camera(camera);
  static_cast<void>(detail::thread_count(options.threads));  // throws for a negative one
  impl_ = detail::with_default_fp_mode([&] { return std::make_unique<Impl>(camera, options); });
}
Rasterizer::~Rasterizer() = default;
Rasterizer::Rasterizer(Rasterizer&&) noexcept = default;
Rasterizer& Rasterizer::operator=(Rasterizer&&) noexcept = default;

void Rasterizer::draw(MeshView mesh, std::uint32_t first_id) {
  detail::check_mesh(mesh, first_id, "Rasterizer::draw");
  detail::with_default_fp_mode([&] { impl_->draw(mesh, first_id); });
}

void Rasterizer::draw(MeshView mesh) { draw(mesh, impl_->options.first_id); }

void Rasterizer::resolve(Frame& frame) const {
  const Camera& camera = impl_->camera;
  detail::check_frame(frame, camera);
  detail::with_default_fp_mode([&] { impl_->resolve(frame); });
}

void Rasterizer::clear() { std::fill(impl_->tiles.begin(), impl_->tiles.end(), clear_tile()); }

void rasterize(MeshView mesh, const Camera& camera, Frame& frame, const RasterOptions& options) {
  detail::check_frame(frame, camera);
  Rasterizer rasterizer(camera, options);
  rasterizer.draw(mesh);
  rasterizer.resolve(frame);
}

}  // namespace plumb
