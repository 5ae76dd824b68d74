#pragma once

#include <algorithm>
#include <cstddef>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace plumb::bench {

/// Calls `work(first, count)` for parts of `total` on `threads` threads; on one thread for the whole
/// at once, on this thread. The same for plumb and its peers.
template <typename Function>
void in_chunks(std::size_t total, int threads, const Function& work) {
  if (threads == 1) {
    work(std::size_t{0}, total);
    return;
  }
  constexpr std::size_t kChunk = 4096;  // a multiple of every packet's size
  tbb::task_arena arena(threads);
  arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, (total + kChunk - 1) / kChunk, [&](std::size_t chunk) {
      const std::size_t first = chunk * kChunk;
      work(first, std::min(kChunk, total - first));
    });
  });
}

}  // namespace plumb::bench
