#pragma once

#include "plumb/simd.h"
#include "trace/query.h"

namespace plumb::detail {

/// The queries over a WideTree<4> or WideTree<8>, for one resolved target.
QueryTable wide4_queries(Simd simd);
QueryTable wide8_queries(Simd simd);

/// Over a CompactTree<8>.
QueryTable wide8_compact_queries(Simd simd);

/// The same as wide8_queries() in the lesser arithmetics, which one width is enough for.
QueryTable wide8_fast_queries(Simd simd);
QueryTable wide8_watertight_queries(Simd simd);

}  // namespace plumb::detail
