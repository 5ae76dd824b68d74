#include "raster/frame_drawer.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "base/simd_dispatch.h"
#include "build/mesh_check.h"
#include "frame/frame_check.h"
#include "pixels/tile.h"
#include "pixels/tile_state.h"

namespace plumb::detail {
namespace {

const Camera& checked(const Camera& camera) {
  check_camera(camera);
  return camera;
}

const RasterOptions& checked(const RasterOptions& options) {
  static_cast<void>(thread_count(options.threads));  // throws where negative
  return options;
}

}  // namespace

FrameDrawer::FrameDrawer(const Camera& camera, const RasterOptions& options)
    : camera_(checked(camera)),
      options_(checked(options)),
      projection_(with_default_fp_mode([&] { return Projection(camera_); })),
      kernels_(raster_kernels(resolve_simd(options.simd))),
      bins_(projection_, kernels_) {}

template <class AnyFrame>
void FrameDrawer::draw_mesh(MeshView mesh, std::uint32_t first_id, bool fresh, AnyFrame& frame) {
  check_mesh(mesh, first_id, "rasterize");
  const glm::vec3& eye = camera_.eye;
  if (!(std::isfinite(eye.x) && std::isfinite(eye.y) && std::isfinite(eye.z))) {  // no ray sees anything
    if (fresh) frame.clear();
    return;
  }
  with_default_fp_mode([&] {
    if (!options_.progress) {
      draw_batches(mesh, first_id, fresh, frame);
      return;
    }
    // What can be cancelled, or whose callback may throw, must be able to take everything back.
    AnyFrame before = frame;
    try {
      draw_batches(mesh, first_id, fresh, frame);
    } catch (...) {
      frame = std::move(before);
      throw;
    }
  });
}

template <class AnyFrame>
void FrameDrawer::draw_batches(MeshView mesh, std::uint32_t first_id, bool fresh, AnyFrame& frame) {
  const std::size_t count = mesh.triangles.size();
  if constexpr (std::is_same_v<AnyFrame, LayeredFrame>) {
    // Its tiles start from what it holds.
    if (fresh) frame.clear();
    fresh = false;
  }
  if (count == 0 && fresh) frame.clear();
  Progress progress(options_.progress, count);
  for (std::size_t first = 0; first < count && !progress.cancelled();) {
    const std::size_t end = bins_.fill(mesh, first, count, options_.threads);
    // The batch's share of the progress, spread over the tiles.
    const std::size_t tiles = bins_.tiles().size();
    parallel_for(tiles, options_.threads, [&](std::size_t i) {
      if (progress.cancelled()) return;
      draw_tile(mesh, first_id, i, fresh, frame);
      progress.add((end - first) * (i + 1) / tiles - (end - first) * i / tiles);
    });
    first = end;
    fresh = false;
  }
  progress.throw_if_cancelled();
}

template <class AnyFrame>
void FrameDrawer::draw_tile(MeshView mesh, std::uint32_t first_id, std::size_t tile, bool fresh,
                            AnyFrame& frame) const {
  TileContents contents;
  bins_.collect(tile, contents);
  if (contents.empty() && !fresh) return;
  const std::size_t columns = static_cast<std::size_t>(bins_.tiles().columns);
  const TileView view{camera_, projection_.exact_only, static_cast<int>(tile % columns) * kTilePx,
                      static_cast<int>(tile / columns) * kTilePx};
  const TileJob job{projection_, view, contents, fresh};
  run(job, MeshTriangles{mesh, first_id}, frame);
}

void FrameDrawer::run(const TileJob& job, const MeshTriangles& triangles, Frame& frame) const {
  if (counts_ != nullptr) {
    kernels_.count_tile(job, triangles, frame, *counts_);
  } else {
    kernels_.draw_tile(job, triangles, frame);
  }
}

void FrameDrawer::run(const TileJob& job, const MeshTriangles& triangles, LayeredFrame& frame) const {
  kernels_.draw_layers(job, triangles, frame);
}

void FrameDrawer::draw(MeshView mesh, std::uint32_t first_id, bool fresh, Frame& frame) {
  draw_mesh(mesh, first_id, fresh, frame);
}

void FrameDrawer::draw(MeshView mesh, std::uint32_t first_id, bool fresh, LayeredFrame& frame) {
  draw_mesh(mesh, first_id, fresh, frame);
}

}  // namespace plumb::detail
