#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "exact/intersect.h"
#include "pixels/tile.h"
#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/layers.h"

namespace plumb::detail {

/// A tile of a camera's frame.
struct TileView {
  const Camera& camera;
  bool exact_only;  ///< directions may be zero or not finite: ask before each exact decision
  int x, y;         ///< of the tile's upper left pixel
};

/// Bounds of 1/t over a tile, as TileTriangle has them: c + a x + b y, `error` more or less.
struct alignas(16) InversePlane {
  float a, b, c, error;
};

/// The triangles drawn into a tile of late, each with what gives its exact depths; pixels refer to them by
/// their place here.
struct DrawnTriangles {
  static constexpr std::size_t kRoom = 1024;

  alignas(64) double normal[kRoom][4];  ///< N and T, as exact/depth-inl.h has them
  alignas(64) double bounds[kRoom][2];  ///< PlaneBounds'
  alignas(64) std::uint32_t id[kRoom];
  InversePlane inverse[kRoom];  ///< of those that won whole blocks
  std::uint32_t index[kRoom];   ///< among the triangles that the tile is drawn from
  std::size_t count;
};

/// A tile while triangles are drawn into it, pixels ordered as pixels/tile.h says. Each pixel's nearest
/// triangle so far has bounds of 1/t; its exact t is computed only where bounds overlap, and once at the
/// end for each pixel that a triangle won.
///
/// A block is whole while all its pixels see the same triangle, or nothing: then only what the block has
/// counts, and nothing is kept for each of its pixels. So a large triangle wins many blocks at once.
struct TileState {
  static constexpr bool kLayered = false;  ///< LayeredTile's is true

  /// None of `drawn`: the pixel's answer is t and id, as the frame held them or as they were settled since. A
  /// whole block sees nothing.
  static constexpr std::uint32_t kEarlier = 0xffffffffu;
  /// Below this 1/t a hit's t might round to infinity.
  static constexpr float kLeastInverse = 0x1p-126f;

  /// Bounds of 1/t of each pixel's nearest triangle so far, wide enough that a triangle certainly
  /// beyond them differs in RN32(t) too. A pixel that sees nothing has -inf and kLeastInverse, so that
  /// every certain hit replaces it.
  alignas(64) float inverse_low[kTilePixels];
  alignas(64) float inverse_high[kTilePixels];
  /// That triangle's place in `drawn`, or kEarlier.
  alignas(64) std::uint32_t winner[kTilePixels];
  alignas(64) float t[kTilePixels];  ///< -inf in pixels outside the frame: nothing wins them.
  alignas(64) std::uint32_t id[kTilePixels];
  /// A bit for each pixel of each block where (t, id) is the winner's exact answer; elsewhere it is still to
  /// be computed.
  alignas(64) std::uint16_t settled[kTileBlocks * kTileBlocks];
  /// At most the least inverse_low of each block, and of the tile: what is certainly farther is hidden in all
  /// of it. They may be out of date, for a pixel's answer only ever comes nearer.
  alignas(64) float block_low[kTileBlocks * kTileBlocks];
  float tile_low;
  /// At least the greatest inverse_high of each whole block, infinite for the others.
  alignas(64) float block_high[kTileBlocks * kTileBlocks];
  /// The `winner` of each whole block's pixels.
  alignas(64) std::uint32_t block_winner[kTileBlocks * kTileBlocks];
  std::uint64_t whole;  ///< a bit for each block that is
  /// What the directions of pixels are made of, component by component: the part of a pixel's column for each
  /// pixel of a block of each column of blocks, and that of its row.
  alignas(64) double direction_x[3][kTileBlocks * kBlockPixels];
  alignas(64) double direction_y[3][kTileBlocks * kBlockPixels];
  /// Blocks whose bounds have changed since block_low and tile_low were computed, a bit each.
  std::uint64_t changed;
  DrawnTriangles drawn;
};

/// A tile of which each pixel keeps the first triangles that it meets, not one. Of what it has as a
/// TileState, `t` is the depth of a pixel's last entry, infinite while there is room for more, and the bounds
/// of 1/t are that one's; `winner`, `settled` and `id` are not used, and no block
/// is whole.
struct LayeredTile : TileState {
  static constexpr bool kLayered = true;

  std::size_t layers;
  /// Pixel by pixel, `layers` for each in (t, id) order; {+inf, kNone} behind the last.
  std::vector<float> depths;
  std::vector<std::uint32_t> ids;
};

/// A triangle as the exact arithmetic takes it, with its place in TileState::drawn.
struct PlacedTriangle {
  std::uint32_t place, id;
  Triangle corners;
};

/// Puts the exact (t, id) of the pixel's winner, which covers it for certain, into `t` and `id`.
void learn_pixel(const TileView& view, TileState& state, int offset, const PlacedTriangle& winner);

/// Decides whether the triangle wins the pixel, which must be settled, and stays so. The bounds of 1/t are
/// left to the caller. True when it does.
bool decide_pixel(const TileView& view, TileState& state, int offset, const PlacedTriangle& triangle);

/// Decides whether the pixel's ray meets the triangle, and adds the hit.
void decide_entry(const TileView& view, LayeredTile& tile, int offset, const PlacedTriangle& triangle);

/// Adds a hit to a pixel's entries, if it is among the first and not there already. The bounds of 1/t are
/// left to the caller.
void add_entry(LayeredTile& tile, int offset, float t, std::uint32_t id);

/// Takes a tile's entries, and `t`, from the frame.
void load_entries(const TileView& view, const LayeredFrame& frame, LayeredTile& tile);
/// Gives them to the frame.
void store_entries(const TileView& view, const LayeredTile& tile, LayeredFrame& frame);

}  // namespace plumb::detail
