#pragma once

#include <cstdint>
#include <vector>

#include "plumb/camera.h"
#include "plumb/cast.h"
#include "plumb/frame.h"
#include "plumb/structure.h"

namespace plumb {

/// The first surfaces that each pixel's ray meets, in (t, id) order: a k-buffer (Bavoil et al. 2007,
/// "Multi-Fragment Effects on the GPU Using the k-Buffer"), for transparency and whatever else must see
/// through what is in front.
struct LayeredFrame {
  /// A clear one. Throws plumb::Error when a size is below 1, or layers is not from 1 to kMostLayers.
  LayeredFrame(int width, int height, int layers);

  static constexpr int kMostLayers = 4096;  ///< of a pixel

  /// Every entry to {+inf, kNone}.
  void clear();

  /// What the pixels see at one depth of the order, from 0: the first is the frame that cast() and
  /// rasterize() make. Throws plumb::Error for a layer that is not there.
  Frame layer(int index) const;

  int width;                 ///< pixels, at least 1
  int height;                ///< pixels, at least 1
  int layers;                ///< entries of a pixel, side by side
  std::vector<float> depth;  ///< of pixel (x, y)'s entry k at (y * width + x) * layers + k; +inf for nothing
  std::vector<std::uint32_t> id;  ///< in the same order; kNone for nothing
};

/// Finds each pixel's first surfaces by rays and overwrites the whole frame. A pixel's entries are the first
/// of what Structure::all() lists for its ray (Structure::first()). `options.method` is not looked at. Throws
/// what cast() throws.
void cast_layers(const Structure& structure, const Camera& camera, LayeredFrame& frame,
                 const CastOptions& options = {});

}  // namespace plumb
