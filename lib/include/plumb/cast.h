#pragma once

#include <functional>
#include <span>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/simd.h"
#include "plumb/structure.h"

namespace plumb {

/// Which way a frame is cast. The answer is the same bits.
enum class CastMethod {
  /// Tiles where the structure can, else rays.
  Auto,
  /// A ray for every pixel, squares of 4x4 together where the structure traces packets.
  Rays,
  /// The tree is walked once for a tile of 32x32 pixels, and the triangles of its leaves are drawn: a wide
  /// Bvh's (width 4 or 8) with Arithmetic::Exact. About three times as fast as rays. Where coordinates are
  /// beyond 2^59, or directions so short, long or skew that their rounding leaves open which pixels see a
  /// box, the frame is cast by rays all the same.
  Tiles,
};

/// How a frame is cast.
struct CastOptions {
  /// Threads; 0 takes all that the affinity mask allows, and more are never used.
  int threads = 0;
  /// Instruction set of the rays; must be Auto, which is the structure's own, or one of simd_targets().
  /// Structures in plain scalar code stay so.
  Simd simd = Simd::Auto;
  /// Which way; plumb::Error where it is Tiles and the structure cannot.
  CastMethod method = CastMethod::Auto;
  /// Called now and then with the share done, rising from 0 to 1, from whichever thread gets there but
  /// never from two at once. Returning false cancels: cast() throws Cancelled. What it throws itself
  /// comes out of cast() too. Either way some pixels may have been overwritten and others not.
  std::function<bool(double)> progress = nullptr;
};

/// Casts the ray of every pixel and overwrites the whole frame. Throws plumb::Error, and leaves the
/// frame as it was, when the frame's size is not the camera's, when it does not hold a depth and an id
/// for each pixel, and for options out of range; and Cancelled when the options' progress says so.
void cast(const Structure& structure, const Camera& camera, Frame& frame, const CastOptions& options = {});

/// The same for many cameras, frames[i] that of cameras[i]: the threads share the work of all, so that many
/// small frames keep them as busy as a large one. Throws as above, naming the frame by its index, and when
/// there are not as many frames as cameras; then all frames are as they were.
void cast(const Structure& structure, std::span<const Camera> cameras, std::span<Frame> frames,
          const CastOptions& options = {});

}  // namespace plumb
