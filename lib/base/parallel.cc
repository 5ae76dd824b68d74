#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <mutex>
#include <string>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "base/fp_mode.h"
#include "plumb/error.h"

namespace plumb::detail {

int thread_count(int requested) {
  if (requested < 0) {
    throw Error("plumb: threads is " + std::to_string(requested) + "; it must be 0 (all) or more");
  }
  // More than oneTBB was told to use (by default the affinity mask's) gains nothing, and oneTBB would
  // print a warning.
  const int allowed =
      static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
  return requested == 0 ? allowed : std::min(requested, allowed);
}

void in_arena(int threads, const std::function<void()>& work) {
  tbb::task_arena arena(thread_count(threads));
  arena.execute(work);
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  const int n = thread_count(threads);
  if (n == 1 || count <= 1) {
    const DefaultFpMode guard;
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  in_arena(n, [&] {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        // A worker thread inherits the mode of whoever started it: set it for each piece of
                        // work.
                        const DefaultFpMode guard;
                        for (std::size_t i = range.begin(); i != range.end(); ++i) work(i);
                      });
  });
}

struct Progress::State {
  std::function<bool(double)> callback;
  std::size_t total;
  std::size_t step;  // report at least this many steps apart
  std::atomic<std::size_t> done{0};
  std::atomic<std::size_t> next;
  std::atomic<bool> cancelled{false};
  std::mutex mutex;
};

Progress::Progress(std::function<bool(double)> callback, std::size_t total)
    : state_(callback ? new State{std::move(callback),
                                  total == 0 ? 1 : total,
                                  total / 256 + 1,
                                  {},
                                  {total / 256 + 1},
                                  {},
                                  {}}
                      : nullptr) {}

Progress::~Progress() { delete state_; }

bool Progress::add(std::size_t steps) {
  if (state_ == nullptr) return true;
  State& s = *state_;
  const std::size_t done = s.done.fetch_add(steps, std::memory_order_relaxed) + steps;
  if (done < s.next.load(std::memory_order_relaxed)) return !s.cancelled.load(std::memory_order_relaxed);
  // Whoever comes while another thread reports just goes on working.
  const std::unique_lock lock(s.mutex, std::try_to_lock);
  // Nor does one whose news are older than what was reported since it counted: shares rise.
  if (lock && done >= s.next.load(std::memory_order_relaxed) &&
      !s.cancelled.load(std::memory_order_relaxed)) {
    s.next.store(done + s.step, std::memory_order_relaxed);
    const double share = static_cast<double>(done) / static_cast<double>(s.total);
    if (!s.callback(share < 1.0 ? share : 1.0)) s.cancelled.store(true, std::memory_order_relaxed);
  }
  return !s.cancelled.load(std::memory_order_relaxed);
}

bool Progress::cancelled() const {
  return state_ != nullptr && state_->cancelled.load(std::memory_order_relaxed);
}

void Progress::throw_if_cancelled() const {
  if (cancelled()) throw Cancelled("plumb: cancelled by the progress callback");
}

}  // namespace plumb::detail
