#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "method.h"
#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"
#include "scene.h"

namespace plumb::tool {

/// A scene of mesh files that are read in parts, whenever it is asked for: one after the other, with ids that
/// go on from file to file.
class StreamScene {
 public:
  /// Looks at each file's beginning. Reading holds so many bytes at most. Throws plumb::Error, for a built-in
  /// scene as well.
  StreamScene(std::vector<std::string> files, std::size_t memory_bytes);

  /// What giving the parts took, or found.
  struct Totals {
    std::uint64_t triangles = 0, vertices = 0, parts = 0;
  };

  /// Gives all parts of all files, with a bar of progress. Throws plumb::Error.
  Totals give(const std::function<void(MeshView part, std::uint32_t first_id)>& part,
              const std::string& label, const ProgressFor& progress) const;

  /// The corners of the box of the finite triangles, as a mesh that has that box and no other; an empty mesh
  /// without such a triangle. Reads all files.
  TriangleMesh box(const ProgressFor& progress) const;

  /// The first file, and how many more.
  std::string name() const;

 private:
  std::vector<std::string> files_;
  std::size_t memory_bytes_;
};

/// A frame of a scene, and what it took.
struct StreamFrame {
  Frame frame;
  StreamScene::Totals totals;
  double seconds;
};

/// Draws the parts as they come, by a run of Method::Raster. Holds two frames at the end of the work, one
/// before.
StreamFrame draw_stream(const StreamScene& scene, const Camera& camera, const Run& run, int threads,
                        const ProgressFor& progress);

/// The scene's camera: that of the options where they say enough, else as of a mesh file.
Camera stream_camera(const FrameOptions& options, const StreamScene& scene, const ProgressFor& progress);

}  // namespace plumb::tool
