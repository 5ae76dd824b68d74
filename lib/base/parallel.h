#pragma once

#include <cstddef>
#include <functional>

namespace plumb::detail {

/// The threads that `requested` asks for: itself, or for 0 all that the affinity mask allows. Throws
/// plumb::Error when negative.
int thread_count(int requested);

/// Calls `work(i)` for every i below `count`, on up to `threads` threads (0: all allowed), each under
/// the default floating-point mode. Returns when all are done; an exception of one is thrown here.
void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

/// Runs `work()` in an arena of up to `threads` threads, so that oneTBB algorithms and task groups
/// inside it keep to that many. The calling thread takes part.
void in_arena(int threads, const std::function<void()>& work);

/// Reports the share done of `total` steps to a callback, rising, never from two threads at once, and
/// remembers when it asked to stop. `add` may be called from many threads; once it returned false
/// the work should end and the owner throw Cancelled.
class Progress {
 public:
  Progress(std::function<bool(double)> callback, std::size_t total);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// False when the work shall stop. Cheap without a callback.
  bool add(std::size_t steps);
  bool cancelled() const;
  /// Throws Cancelled if it was.
  void throw_if_cancelled() const;

 private:
  struct State;
  State* state_;
};

}  // namespace plumb::detail
