// Tiles of pixels through 4-wide trees, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tiles/wide4_tiles.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "tiles/tile_kernel.h"
#include "tiles/tile_walk-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

TileCaster Wide4TileCaster() { return MakeTileCaster<4>(); }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(Wide4TileCaster);

TileCaster wide4_tile_caster(Simd simd) { return PLUMB_DISPATCH(Wide4TileCaster, simd)(); }

}  // namespace plumb::detail
#endif
