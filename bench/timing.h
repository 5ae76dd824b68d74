#pragma once

#include <functional>
#include <vector>

namespace plumb::bench {

/// Seconds each of the works takes: the median of several rounds, in each of which every work runs once,
/// so that what else the machine does meets all alike. On one thread CPU time of the process, which other
/// programs disturb little; on more the clock on the wall, which they do disturb.
std::vector<double> time_interleaved(const std::vector<std::function<void()>>& works, int rounds,
                                     int threads);

}  // namespace plumb::bench
