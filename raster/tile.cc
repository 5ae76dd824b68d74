// The tile kernel, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/tile.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "raster/tile_draw-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

DrawTile DrawTileKernel() { return &DrawTileRecords; }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(DrawTileKernel);

DrawTile draw_tile_kernel(Simd simd) { return PLUMB_DISPATCH(DrawTileKernel, simd)(); }

}  // namespace plumb::detail
#endif
