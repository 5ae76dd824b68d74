// The queries over compact 8-wide trees, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/wide8_compact.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "trace/span-inl.h"
#include "trace/wide_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

QueryTable Wide8CompactQueries() { return MakeSpanQueryTable<CompactTree<8>>(); }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(Wide8CompactQueries);

QueryTable wide8_compact_queries(Simd simd) { return PLUMB_DISPATCH(Wide8CompactQueries, simd)(); }

}  // namespace plumb::detail
#endif
