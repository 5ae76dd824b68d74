#pragma once

#include <memory>
#include <string>
#include <vector>

#include "plumb/camera.h"
#include "plumb/mesh.h"

namespace plumb::peers {

/// A mesh and a view handed to Mesa's software rasterizer to be drawn as fast as it can: buffers that stay,
/// vertices transformed by a matrix in float, a 32-bit id and a 32-bit depth. peers/llvmpipe.h is the one
/// whose answers are as good as it can give. One thread at a time.
class LlvmpipeScene {
 public:
  /// Null where the library is not on this machine or makes no such context, and where the camera's axes span
  /// no pyramid. How many threads it draws with, LP_NUM_THREADS in the environment says when the first
  /// context of a process is made; 0 is the calling thread alone.
  static std::unique_ptr<LlvmpipeScene> open(MeshView mesh, const Camera& camera);
  ~LlvmpipeScene();

  /// Clears and draws, and waits until that is done.
  void draw();
  /// The triangle that each pixel saw, row by row, or kNone. Throws plumb::Error when drawing failed.
  std::vector<std::uint32_t> ids();

  struct Impl;

 private:
  explicit LlvmpipeScene(std::unique_ptr<Impl> impl);

  std::unique_ptr<Impl> impl_;
};

/// What it calls itself, "llvmpipe (LLVM 15.0.6, 256 bits)"; empty where it is not there.
std::string llvmpipe_name();

}  // namespace plumb::peers
