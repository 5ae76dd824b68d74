// The queries over 4-wide trees, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/wide4.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "trace/span-inl.h"
#include "trace/wide_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

QueryTable Wide4Queries() { return MakeSpanQueryTable<WideTree<4>>(); }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(Wide4Queries);

QueryTable wide4_queries(Simd simd) { return PLUMB_DISPATCH(Wide4Queries, simd)(); }

}  // namespace plumb::detail
#endif
