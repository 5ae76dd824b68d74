// The kernels, compiled once per Highway target.

#include "raster/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "raster/kernels.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "raster/binning-inl.h"
#include "raster/tile_draw-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

RasterKernels MakeRasterKernels() { return {&BinTriangles, &DrawTile, &DrawLayers, &CountTile}; }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(MakeRasterKernels);

RasterKernels raster_kernels(Simd simd) { return PLUMB_DISPATCH(MakeRasterKernels, simd)(); }

}  // namespace plumb::detail
#endif
