#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"

namespace plumb {

struct RasterOptions {
  /// Threads; 0 takes all that the affinity mask allows.
  int threads = 0;
  /// plumb::Error if this machine cannot run it.
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle, where the mesh is a part of a larger scene.
  std::uint32_t first_id = 0;
  /// Called now and then with the share done, 0 to 1, never from two threads at once. Returning
  /// false cancels: Cancelled is thrown and nothing of the call is merged into the frame.
  std::function<bool(double)> progress;
};

/// Draws triangles into tiles over many calls, then resolves them into a frame. The answer is that
/// of one ray per pixel (docs/visibility.md) and does not depend on the order or number of calls.
/// Not safe for concurrent calls on one object; it runs on many threads inside.
class Rasterizer {
 public:
  explicit Rasterizer(const Camera& camera, const RasterOptions& options = {});
  ~Rasterizer();
  Rasterizer(Rasterizer&&) noexcept;
  Rasterizer& operator=(Rasterizer&&) noexcept;

  /// Draws the mesh; `first_id` is the id of its first triangle. Keeps nothing of the view. Throws
  /// plumb::Error for an index out of range or ids that reach kNone; then nothing was drawn.
  void draw(MeshView mesh, std::uint32_t first_id);
  /// The same with the options' first_id.
  void draw(MeshView mesh);

  /// Merges what was drawn into the frame by (t, id): a pixel of the frame that is nearer stays.
  /// Throws plumb::Error when the frame's size is not the camera's.
  void resolve(Frame& frame) const;

  /// Forgets what was drawn.
  void clear();

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

/// Draws a mesh as the camera sees it and merges it into the frame by (t, id); a clear frame gives
/// the picture alone. Throws plumb::Error as Rasterizer does.
void rasterize(MeshView mesh, const Camera& camera, Frame& frame, const RasterOptions& options = {});

}  // namespace plumb
