#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/layers.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"

namespace plumb {

/// How triangles are drawn.
struct RasterOptions {
  /// Threads; 0 takes all that the affinity mask allows, and more are never used.
  int threads = 0;
  /// Instruction set of the kernels; must be Auto or one of simd_targets().
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene. All ids must be
  /// below kNone.
  std::uint32_t first_id = 0;
  /// Called now and then with the share of a draw() done, rising from 0 to 1, from whichever thread gets
  /// there but never from two at once. Returning false cancels: Cancelled is thrown and nothing of
  /// that draw() remains. So it is when the callback throws, and its exception comes out. With a
  /// callback each draw() first copies what was drawn, 8 bytes a pixel.
  std::function<bool(double)> progress = nullptr;
  /// Of rasterize(): the mesh alone is drawn, over whatever the frame held, which saves clearing and reading
  /// it. Of no meaning for a Rasterizer, which holds a frame of its own.
  bool overwrite = false;
};

/// Draws triangles into tiles over many calls, then resolves them into a frame.
///
/// The answer is that of one ray per pixel (docs/visibility.md), bit for bit, and does not depend on the
/// order or number of calls: a scene too large for the memory can be drawn in parts, each with the ids
/// it has in the whole. There is no near plane and no clipping. Not safe for concurrent calls on one
/// object; it runs on many threads inside. One that was moved from can only be assigned to.
///
/// Homogeneous edge functions over tiles (Olano and Greer 1997, "Triangle Scan Conversion using 2D
/// Homogeneous Coordinates").
class Rasterizer {
 public:
  /// Nothing drawn yet. Throws plumb::Error for a camera with a size below 1 and options out of range.
  explicit Rasterizer(const Camera& camera, const RasterOptions& options = {});
  ~Rasterizer();
  /// Takes over what was drawn.
  Rasterizer(Rasterizer&&) noexcept;
  /// Takes over what was drawn.
  Rasterizer& operator=(Rasterizer&&) noexcept;

  /// Draws the mesh; `first_id` is the id of its first triangle. Keeps nothing of the view. Throws
  /// plumb::Error for a vertex index out of range and ids that reach kNone, and Cancelled when the
  /// options' progress says so; then nothing of this mesh was drawn.
  void draw(MeshView mesh, std::uint32_t first_id);
  /// The same with the options' first_id.
  void draw(MeshView mesh);

  /// Merges what was drawn into the frame by the smallest (t, id): a pixel of the frame that is nearer
  /// stays. What was drawn stays as well and more may follow. Throws plumb::Error when the frame's
  /// size is not the camera's or the frame does not hold a depth and an id for each pixel.
  void resolve(Frame& frame) const;

  /// Forgets what was drawn.
  void clear();

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// What rasterizing a mesh takes: the descent of a quadtree over the screen, several of its levels a step.
struct RasterCounts {
  std::uint64_t triangles = 0;  ///< of the mesh
  std::uint64_t tiles =
      0;  ///< tiles of 32 x 32 pixels that a triangle that may be seen was sent to, over all
  std::uint64_t tiles_hidden = 0;    ///< of these, such as had only nearer things already
  std::uint64_t block_tests = 0;     ///< blocks of 4 x 4 pixels tested before any pixel of theirs
  std::uint64_t blocks = 0;          ///< blocks whose pixels were tested
  std::uint64_t blocks_full = 0;     ///< of these, such as the triangle covers for certain
  std::uint64_t pixels_decided = 0;  ///< pixels whose coverage or depth the float tests left open
};

/// Counts what rasterize() tests for a mesh alone, drawn by one thread; `options.threads` and the callback
/// are not looked at. Throws what rasterize() throws.
RasterCounts count_raster_tests(MeshView mesh, const Camera& camera, const RasterOptions& options = {});

/// Draws a mesh as the camera sees it and merges it into the frame by (t, id); a clear frame, or any with
/// RasterOptions::overwrite, gives the picture alone. Throws what Rasterizer does, and then leaves the frame
/// as it was.
void rasterize(MeshView mesh, const Camera& camera, Frame& frame, const RasterOptions& options = {});

/// Finds each pixel's first surfaces in (t, id) order by drawing a mesh, and merges them into the frame by
/// that order: parts of a scene may follow each other, and a hit that the frame has already is not added
/// twice. Throws what rasterize() does, and then leaves the frame as it was.
void rasterize_layers(MeshView mesh, const Camera& camera, LayeredFrame& frame,
                      const RasterOptions& options = {});

/// Draws a mesh as many cameras see it, frames[i] that of cameras[i]: where there are as many as threads, a
/// frame on each thread, else one frame after the other on all. Throws as above, naming the frame by its
/// index, and when there are not as many frames as cameras; frames that were finished before the callback
/// cancelled or threw stay.
void rasterize(MeshView mesh, std::span<const Camera> cameras, std::span<Frame> frames,
               const RasterOptions& options = {});

}  // namespace plumb
