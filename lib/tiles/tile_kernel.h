#pragma once

#include "pixels/tile_state.h"
#include "plumb/frame.h"
#include "plumb/simd.h"
#include "tiles/tile_frustum.h"

namespace plumb::detail {

/// How a structure is cast a tile at a time.
struct TileCaster {
  /// The greatest |coordinate| of the structure's finite triangles, for FrameFrustum.
  float (*greatest)(const void* structure);
  /// Casts one tile and overwrites its pixels; `frame` must be usable and hold for the view's camera. Callers
  /// hold the default floating-point mode.
  void (*cast)(const void* structure, const FrameFrustum& frustum, const TileView& view, Frame& frame);
};

/// Those of WideTree<4> and WideTree<8>, for one resolved target.
TileCaster wide4_tile_caster(Simd simd);
TileCaster wide8_tile_caster(Simd simd);

}  // namespace plumb::detail
