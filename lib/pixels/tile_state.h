#pragma once

#include <cstdint>

#include "pixels/tile.h"
#include "plumb/camera.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// What a tile is drawn from.
struct TileTask {
  const Camera& camera;
  bool exact_only;  ///< directions may be zero or not finite: ask before each exact decision
  MeshView mesh;
  std::uint32_t first_id;
  int x, y;  ///< of the tile's upper left pixel
};

/// A tile while triangles are drawn into it, pixels ordered as pixels/tile.h says. Each pixel's nearest
/// triangle so far has bounds of 1/t; its exact t is computed only where bounds overlap, and once at the
/// end for each pixel that a triangle won.
struct TileState {
  /// No triangle of this call: the pixel's answer is still what the frame held.
  static constexpr std::uint32_t kEarlier = 0xffffffffu;
  /// Below this 1/t a hit's t might round to infinity.
  static constexpr float kLeastInverse = 0x1p-126f;

  /// Bounds of 1/t of each pixel's nearest triangle so far, wide enough that a triangle certainly
  /// beyond them differs in RN32(t) too. A pixel that sees nothing has -inf and kLeastInverse, so that
  /// every certain hit replaces it.
  alignas(64) float inverse_low[kTilePixels];
  alignas(64) float inverse_high[kTilePixels];
  /// That triangle's index in the mesh, or kEarlier.
  alignas(64) std::uint32_t winner[kTilePixels];
  /// Whose exact answer (t, id) is; where that is not `winner`, the answer is still to be computed.
  alignas(64) std::uint32_t known[kTilePixels];
  alignas(64) float t[kTilePixels];  ///< -inf in pixels outside the frame: nothing wins them.
  alignas(64) std::uint32_t id[kTilePixels];
  /// At most the least inverse_low of each block, and of the tile: what is certainly farther is hidden in all
  /// of it. They may be out of date, for a pixel's answer only ever comes nearer.
  alignas(64) float block_low[kTileBlocks * kTileBlocks];
  float tile_low;
  /// Blocks whose pixels' bounds have changed since block_low was computed, a bit each.
  std::uint64_t changed;
};

/// Computes (t, id) of the pixel's winner, which covers it for certain.
void learn_pixel(const TileTask& task, TileState& state, int offset);

/// Decides whether the triangle wins the pixel, whose winner must be known. The bounds of 1/t are left
/// to the caller. True when it does.
bool decide_pixel(const TileTask& task, TileState& state, int offset, std::uint32_t triangle);

}  // namespace plumb::detail
