#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// Ways to make a frame.
enum class VisibleMethod {
  Raster,  ///< rasterize()
  Tiles,   ///< cast() with CastMethod::Tiles
  Rays,    ///< cast() with CastMethod::Rays
};

/// "raster", "tiles" or "rays".
const char* visible_method_name(VisibleMethod method);

/// How a frame is made whichever way is taken.
struct VisibleOptions {
  /// Threads; 0 takes all that the affinity mask allows, and more are never used.
  int threads = 0;
  /// Instruction set; must be Auto or one of simd_targets().
  Simd simd = Simd::Auto;
  /// The id of the mesh's first triangle; a structure must have been built with the same.
  std::uint32_t first_id = 0;
  /// As RasterOptions::progress and CastOptions::progress have it.
  std::function<bool(double)> progress = nullptr;
};

/// Which way a frame is made, and why.
struct VisibleChoice {
  VisibleMethod method;  ///< the way
  std::string reason;    ///< a sentence
};

/// The way that visible() takes; `structure` may be null. In time that does not depend on the scene: at most
/// 1024 of its triangles are looked at. docs/performance.md shows the measurements behind the rules, and what
/// they cost where another way would have been faster. Throws plumb::Error for a camera with a size below 1,
/// a vertex index out of range among those looked at, and a structure of another number of triangles.
VisibleChoice choose_visible(MeshView mesh, const Structure* structure, const Camera& camera);

/// What the camera sees, by whichever way promises to be fastest: the frame is overwritten, and the same bits
/// whichever that is. Without a structure the mesh is rasterized, as building one takes longer than a frame;
/// who wants several frames of a scene hands a Bvh over. Throws what rasterize() and cast() throw, and what
/// choose_visible() does.
VisibleChoice visible(MeshView mesh, const Camera& camera, Frame& frame, const VisibleOptions& options = {});

/// The same with a structure built over the same mesh.
VisibleChoice visible(MeshView mesh, const Structure& structure, const Camera& camera, Frame& frame,
                      const VisibleOptions& options = {});

}  // namespace plumb
