#pragma once

#include <functional>

#include "pixels/projection.h"
#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/layers.h"
#include "plumb/mesh.h"
#include "plumb/raster.h"
#include "raster/bins.h"
#include "raster/kernels.h"

namespace plumb::detail {

/// Draws meshes into a frame as one camera sees them, batch by batch and tile by tile.
class FrameDrawer {
 public:
  /// Throws plumb::Error for a camera without pixels or options that cannot be met.
  FrameDrawer(const Camera& camera, const RasterOptions& options);
  FrameDrawer(const FrameDrawer&) = delete;
  FrameDrawer& operator=(const FrameDrawer&) = delete;

  const Camera& camera() const { return camera_; }
  const RasterOptions& options() const { return options_; }

  /// Merges the mesh into the frame, or with `fresh` overwrites it. Throws plumb::Error for a mesh that is at
  /// fault, Cancelled when the progress callback says so, and whatever that throws; in each case the frame is
  /// as it was.
  void draw(MeshView mesh, std::uint32_t first_id, bool fresh, Frame& frame);

  /// The same into a layered frame.
  void draw(MeshView mesh, std::uint32_t first_id, bool fresh, LayeredFrame& frame);

  /// From now on counts what is tested when drawing into a Frame; for one thread only. The counts must
  /// outlive the drawer.
  void count(RasterCounts& counts) { counts_ = &counts; }

 private:
  template <class AnyFrame>
  void draw_mesh(MeshView mesh, std::uint32_t first_id, bool fresh, AnyFrame& frame);
  template <class AnyFrame>
  void draw_batches(MeshView mesh, std::uint32_t first_id, bool fresh, AnyFrame& frame);
  template <class AnyFrame>
  void draw_tile(MeshView mesh, std::uint32_t first_id, std::size_t tile, bool fresh, AnyFrame& frame) const;
  void run(const TileJob& job, const MeshTriangles& triangles, Frame& frame) const;
  void run(const TileJob& job, const MeshTriangles& triangles, LayeredFrame& frame) const;

  Camera camera_;
  RasterOptions options_;
  Projection projection_;
  RasterKernels kernels_;
  Bins bins_;
  RasterCounts* counts_ = nullptr;
};

}  // namespace plumb::detail
