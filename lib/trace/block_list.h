#pragma once

#include <cstdint>

#include "base/aligned.h"
#include "plumb/simd.h"
#include "trace/query.h"
#include "wide/triangle_block.h"

namespace plumb::detail {

/// Triangles in blocks of eight and nothing else.
struct BlockList {
  AlignedVector<TriangleBlock<8>> blocks;
  std::uint32_t count = 0;  ///< triangles
  float greatest = 0.0f;    ///< greatest |coordinate| among them
};

/// The queries over a BlockList, for one resolved target.
QueryTable block_list_queries(Simd simd);

}  // namespace plumb::detail
