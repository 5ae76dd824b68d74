#pragma once

#include <algorithm>
#include <cstddef>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "base/fp_mode.h"

// Loops over fixed pieces of an array, run by the threads of the arena that they are called in.

namespace plumb::detail {

/// Where piece i of `pieces` begins among `count` elements (and piece i - 1 ends).
inline std::size_t piece_begin(std::size_t count, std::size_t pieces, std::size_t i) {
  return count / pieces * i + std::min(i, count % pieces);
}

/// Into how many pieces of about `size` elements a loop over `count` of them is worth splitting.
inline std::size_t piece_count(std::size_t count, std::size_t size) {
  if (tbb::this_task_arena::max_concurrency() == 1) return 1;
  return std::clamp<std::size_t>(count / size, 1, 256);
}

/// Calls work(i, begin, end) for every piece, each under the default floating-point mode.
template <typename Work>
void for_pieces(std::size_t count, std::size_t pieces, const Work& work) {
  if (pieces == 1) {
    work(std::size_t{0}, std::size_t{0}, count);
    return;
  }
  tbb::parallel_for(std::size_t{0}, pieces, [&](std::size_t i) {
    const DefaultFpMode guard;
    work(i, piece_begin(count, pieces, i), piece_begin(count, pieces, i + 1));
  });
}

}  // namespace plumb::detail
