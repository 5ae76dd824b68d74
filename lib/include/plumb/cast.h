#pragma once

#include <functional>

#include "plumb/brute_force.h"
#include "plumb/bvh.h"
#include "plumb/camera.h"
#include "plumb/frame.h"

namespace plumb {

struct CastOptions {
  /// Threads; 0 takes all that the affinity mask allows.
  int threads = 0;
  /// Called now and then with the share done, 0 to 1, never from two threads at once. Returning
  /// false cancels: Cancelled is thrown and the frame's contents are unspecified.
  std::function<bool(double)> progress;
};

/// Casts the ray of every pixel and overwrites the whole frame. Throws plumb::Error when the frame's
/// size is not the camera's.
void cast(const Bvh& bvh, const Camera& camera, Frame& frame, const CastOptions& options = {});
void cast(const BruteForce& brute, const Camera& camera, Frame& frame, const CastOptions& options = {});

}  // namespace plumb
