#pragma once

#include <memory>
#include <optional>
#include <string>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"

namespace plumb::peers {

/// Mesa's software rasterizer, through OSMesa and OpenGL 4.5: 32-bit float depth, the nearest at 1 and
/// falling with 1/t, vertices projected in double, the triangle's id from gl_PrimitiveID and the depth from
/// gl_FragCoord.w. One draw at a time, from any thread.
class Llvmpipe {
 public:
  /// Null where the library is not on this machine or makes no such context.
  static std::unique_ptr<Llvmpipe> open();
  ~Llvmpipe();

  /// What it calls itself: "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6".
  std::string name() const;

  /// The frame as drawn, triangles in order, an equal depth not drawn over. Nothing where the camera's axes
  /// span no pyramid. Triangles that are not finite are left out, as OpenGL asks.
  std::optional<Frame> draw(MeshView mesh, const Camera& camera);

  struct Impl;

 private:
  explicit Llvmpipe(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

}  // namespace plumb::peers
