// The queries over a list of triangles, compiled once per Highway target.

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "trace/block_list.cc"
#include "hwy/foreach_target.h"
// After foreach_target.
#include "hwy/highway.h"
#include "trace/block_list.h"
#include "trace/exact_tests-inl.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::detail::HWY_NAMESPACE {

struct BlockListTraversal {
  template <class Query>
  static void run(const BlockList& list, const Ray& ray, Query& query) {
    // So many that a nearer hit soon spares the depths of those behind it.
    constexpr std::uint32_t kAtOnce = 64;
    ExactTests<8> tests(list.greatest, ray, query.limit());
    for (std::uint32_t first = 0; first < list.count; first += kAtOnce) {
      const std::uint32_t count = HWY_MIN(kAtOnce, list.count - first);
      query.count_triangles(count);
      if (tests.leaf(&list.blocks[first / 8], count, query)) return;
    }
  }
};

QueryTable BlockListQueries() { return make_query_table<BlockList, BlockListTraversal>(); }

}  // namespace plumb::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/simd_dispatch.h"

namespace plumb::detail {

HWY_EXPORT(BlockListQueries);

QueryTable block_list_queries(Simd simd) { return PLUMB_DISPATCH(BlockListQueries, simd)(); }

}  // namespace plumb::detail
#endif
