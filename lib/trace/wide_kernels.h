#pragma once

#include "plumb/simd.h"
#include "trace/query.h"

namespace plumb::detail {

/// The queries over a WideTree<4> or WideTree<8>, for one resolved target.
QueryTable wide4_queries(Simd simd);
QueryTable wide8_queries(Simd simd);

}  // namespace plumb::detail
