#include "timing.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>

namespace plumb::bench {
namespace {

double now(int threads) {
  if (threads == 1) return static_cast<double>(std::clock()) / static_cast<double>(CLOCKS_PER_SEC);
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t middle = values.size() / 2;
  return values.size() % 2 == 1 ? values[middle] : 0.5 * (values[middle - 1] + values[middle]);
}

}  // namespace

std::vector<double> time_interleaved(const std::vector<std::function<void()>>& works, int rounds,
                                     int threads) {
  std::vector<std::vector<double>> seconds(works.size());
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < works.size(); ++i) {
      const double start = now(threads);
      works[i]();
      seconds[i].push_back(now(threads) - start);
    }
  }
  std::vector<double> medians;
  for (const std::vector<double>& all : seconds) medians.push_back(median(all));
  return medians;
}

}  // namespace plumb::bench
