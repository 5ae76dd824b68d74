#pragma once

#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <utility>

namespace plumb::bench {

/// Keeps things that are slow to make (ray sets, trees) under their names. When it is full the one
/// made first goes, so that a long list of benchmarks does not fill the memory.
template <typename T>
class Shelf {
 public:
  explicit Shelf(std::size_t capacity) : capacity_(capacity) {}

  std::shared_ptr<T> get(const std::string& name, const std::function<std::shared_ptr<T>()>& make) {
    for (const auto& [known, thing] : things_) {
      if (known == name) return thing;
    }
    if (things_.size() == capacity_) things_.pop_front();
    things_.emplace_back(name, make());
    return things_.back().second;
  }

 private:
  std::size_t capacity_;
  std::deque<std::pair<std::string, std::shared_ptr<T>>> things_;
};

}  // namespace plumb::bench
