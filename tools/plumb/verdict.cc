#include "verdict.h"

#include <algorithm>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

#include "plumb/ray.h"

namespace plumb::tool {
namespace {

// The depth is the shortest decimal that reads back as the same float, so that unequal depths look
// unequal.
std::string sight(float depth, std::uint32_t id) {
  return id == kNone ? fmt::format("nothing (t {})", depth) : fmt::format("triangle {} at t {}", id, depth);
}

}  // namespace

ExitStatus exit_status(const std::vector<Pair>& pairs) {
  const bool agree =
      std::all_of(pairs.begin(), pairs.end(), [](const Pair& pair) { return pair.comparison.equal(); });
  return agree ? kAgree : kDiffer;
}

std::string summary(const Pair& pair) {
  const Comparison& c = pair.comparison;
  const std::string where = pair.layer == 0 ? "" : fmt::format("layer {} ", pair.layer);
  if (c.equal()) return fmt::format("{}agrees with {}", where, pair.a);
  return fmt::format("{}DIFFERS from {} in {} of {} pixels (id in {}, depth in {})", where, pair.a,
                     c.different_pixels, c.pixels, c.different_ids, c.different_depths);
}

std::string differences(const Pair& pair) {
  const Comparison& c = pair.comparison;
  std::string text;
  for (const PixelDifference& d : c.first) {
    fmt::format_to(std::back_inserter(text), "    pixel ({}, {}): {} saw {}, {} saw {}\n", d.x, d.y, pair.a,
                   sight(d.depth_a, d.id_a), pair.b, sight(d.depth_b, d.id_b));
  }
  if (c.different_pixels > c.first.size()) {
    fmt::format_to(std::back_inserter(text), "    and {} more\n", c.different_pixels - c.first.size());
  }
  return text;
}

}  // namespace plumb::tool
