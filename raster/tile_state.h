#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

#include "exact/intersect.h"
#include "pixels/tile.h"
#include "raster/tile.h"
#include "scene/pixel_direction.h"

namespace plumb::detail {

/// No triangle of this call: the pixel's answer is still that of earlier ones (TilePixels).
inline constexpr std::uint32_t kEarlier = 0xffffffffu;

/// A tile while triangles are drawn into it. Each pixel's nearest triangle so far has bounds of 1/t; its
/// exact t is computed only where bounds overlap, and once at the end for each pixel that a triangle won.
class TileState {
 public:
  TileState(const TileTask& task, TilePixels& pixels);

  /// Bounds of 1/t of each pixel's nearest triangle so far, wide enough that a triangle certainly
  /// beyond them differs in RN32(t) too. A pixel that sees nothing has -inf and kLeastInverse, so
  /// that every certain hit replaces it; one outside the frame +inf, so that nothing does.
  alignas(64) float inverse_low[kTilePixels];
  alignas(64) float inverse_high[kTilePixels];
  /// That triangle's index in the mesh, or kEarlier.
  alignas(64) std::uint32_t index[kTilePixels];
  /// The least inverse_low of each block: what is certainly farther is hidden in all of it.
  alignas(64) float block_low[kTileBlocks * kTileBlocks];

  /// Below this 1/t a hit's t might round to infinity, above kGreatestInverse the spacing of floats is no
  /// longer relative (t is near the subnormal numbers): the exact arithmetic decides there.
  static constexpr float kLeastInverse = 0x1p-126f;
  static constexpr float kGreatestInverse = 0x1p100f;

  /// Decides exactly whether the mesh's triangle wins the pixel at the offset.
  void decide(int offset, std::uint32_t triangle);

  /// Takes the block's least bound anew.
  void update_block(int block);

  /// Gives every pixel that a triangle won its exact t and id.
  void finish();

 private:
  glm::vec3 direction(int offset) const {
    return pixel_direction(task_.camera, task_.x + tile_x(offset), task_.y + tile_y(offset));
  }
  Triangle triangle_at(std::uint32_t triangle) const {
    const glm::uvec3& corner = task_.mesh.triangles[triangle];
    return {task_.mesh.positions[corner.x], task_.mesh.positions[corner.y], task_.mesh.positions[corner.z]};
  }
  bool in_frame(int offset) const {
    return task_.x + tile_x(offset) < task_.camera.width && task_.y + tile_y(offset) < task_.camera.height;
  }
  Hit nearest(int offset);
  void set_bounds(int offset, float t);

  const TileTask& task_;
  TilePixels& pixels_;
  // The exact t of the pixel's nearest triangle, where it has been computed: where known_ is its index.
  alignas(64) float known_t_[kTilePixels];
  alignas(64) std::uint32_t known_[kTilePixels];
};

}  // namespace plumb::detail
