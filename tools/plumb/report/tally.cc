#include "report/tally.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace plumb::tool {
namespace {

// Floats in their order as integers one after the other, both zeros as 0.
std::int64_t rank(float f) {
  const auto bits = std::bit_cast<std::uint32_t>(f);
  const std::int64_t magnitude = bits & 0x7fffffffu;
  return bits == magnitude ? magnitude : -magnitude;
}

bool same_bits(const Hit& a, const Hit& b) {
  return a.id == b.id && std::bit_cast<std::uint32_t>(a.t) == std::bit_cast<std::uint32_t>(b.t);
}

}  // namespace

Tally& Tally::operator+=(const Tally& other) {
  asked += other.asked;
  different += other.different;
  wrong_ids += other.wrong_ids;
  lost += other.lost;
  extra += other.extra;
  other_surface += other.other_surface;
  same_depth += other.same_depth;
  other_depths += other.other_depths;
  worst_ulps = std::max(worst_ulps, other.worst_ulps);
  return *this;
}

std::uint32_t ulps_between(float a, float b) {
  if (std::isnan(a) || std::isnan(b)) return std::numeric_limits<std::uint32_t>::max();
  return static_cast<std::uint32_t>(std::abs(rank(a) - rank(b)));
}

void count(Tally& tally, const Hit& exact, const Hit& answer, const PlaneDepth& plane_depth) {
  ++tally.asked;
  if (same_bits(exact, answer)) return;
  ++tally.different;
  const bool is_wrong = exact.id != answer.id;
  if (is_wrong) ++tally.wrong_ids;
  if (is_wrong && exact.id == kNone) {
    ++tally.extra;
    return;
  }
  if (is_wrong && answer.id == kNone) {
    ++tally.lost;
    return;
  }
  if (is_wrong && plane_depth(answer.id) != exact.t) {
    ++tally.other_surface;
    return;
  }
  if (is_wrong) ++tally.same_depth;
  const std::uint32_t ulps = ulps_between(exact.t, answer.t);
  if (ulps == 0) return;
  ++tally.other_depths;
  tally.worst_ulps = std::max(tally.worst_ulps, ulps);
}

}  // namespace plumb::tool
