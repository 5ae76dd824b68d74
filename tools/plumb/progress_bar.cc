#include "progress_bar.h"

#include <cstddef>
#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

namespace plumb::tool {
namespace {

constexpr std::size_t kBarWidth = 40;
constexpr const char* kWipeLine = "\r\x1b[K";

/// Draws whenever another percent is done.
class Bar {
 public:
  explicit Bar(std::string label) : label_(std::move(label)) {}
  ~Bar() { fmt::print(stderr, "{}", kWipeLine); }
  Bar(const Bar&) = delete;
  Bar& operator=(const Bar&) = delete;

  void draw(double share) {
    const int percent = static_cast<int>(share * 100.0);
    if (percent == percent_) return;
    percent_ = percent;
    const auto filled = static_cast<std::size_t>(share * static_cast<double>(kBarWidth));
    fmt::print(stderr, "{}{} [{:<{}}] {:3}%", kWipeLine, label_, std::string(filled, '#'), kBarWidth,
               percent);
    std::fflush(stderr);
  }

 private:
  std::string label_;
  int percent_ = -1;
};

}  // namespace

std::function<bool(double)> progress_bar(const std::string& label) {
  if (isatty(STDERR_FILENO) == 0) return {};
  return [bar = std::make_shared<Bar>(label)](double share) {
    bar->draw(share);
    return true;
  };
}

}  // namespace plumb::tool
