#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "plumb/ray.h"
#include "report/tally.h"

using plumb::Hit;
using plumb::kNone;
using plumb::tool::count;
using plumb::tool::Tally;
using plumb::tool::ulps_between;

namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();

// One answer where triangles 0 and 1 lie at depth 2 and triangle 2 at depth 3.
Tally counted(const Hit& exact, const Hit& answer) {
  Tally tally;
  count(tally, exact, answer, [](std::uint32_t id) -> std::optional<float> {
    if (id > 2) return std::nullopt;
    return id == 2 ? 3.0f : 2.0f;
  });
  return tally;
}

}  // namespace

TEST_SUITE_BEGIN("tool: tally");

TEST_CASE("floats are counted from one to the other, across zero and up to infinity") {
  CHECK(ulps_between(1.0f, 1.0f) == 0);
  CHECK(ulps_between(1.0f, std::nextafter(1.0f, 2.0f)) == 1);
  CHECK(ulps_between(std::nextafter(1.0f, 0.0f), std::nextafter(1.0f, 2.0f)) == 2);
  CHECK(ulps_between(1.0f, 2.0f) == 1u << 23);
  CHECK(ulps_between(0.0f, -0.0f) == 0);
  CHECK(ulps_between(0x1p-149f, -0x1p-149f) == 2);
  CHECK(ulps_between(std::numeric_limits<float>::max(), kInf) == 1);
  CHECK(ulps_between(-kInf, kInf) == 0xff000000u);
  CHECK(ulps_between(std::numeric_limits<float>::quiet_NaN(), 1.0f) == 0xffffffffu);
}

TEST_CASE("an answer equal in all bits is counted as asked and nothing else") {
  Tally expected;
  expected.asked = 1;
  CHECK(counted({2.0f, 0}, {2.0f, 0}) == expected);
  CHECK(counted(Hit{}, Hit{}) == expected);
}

TEST_CASE("each wrong id is of one kind") {
  Tally expected;
  expected.asked = expected.different = expected.wrong_ids = 1;
  Tally lost = expected, extra = expected, other = expected, same = expected;
  lost.lost = extra.extra = other.other_surface = same.same_depth = 1;
  CHECK(counted({2.0f, 0}, Hit{}) == lost);
  CHECK(counted(Hit{}, {2.0f, 0}) == extra);
  CHECK(counted({2.0f, 0}, {3.0f, 2}) == other);
  CHECK(counted({2.0f, 0}, {2.0f, 2}) == other);  // the depth it claims is not asked
  CHECK(counted({2.0f, 0}, {2.0f, 7}) == other);  // no such triangle
  CHECK(counted({2.0f, 0}, {2.0f, 1}) == same);
}

TEST_CASE("depths count on the right surface alone, and the worst is kept") {
  Tally tally = counted({2.0f, 0}, {std::nextafter(2.0f, 3.0f), 0});
  CHECK(tally.different == 1);
  CHECK(tally.wrong_ids == 0);
  CHECK(tally.other_depths == 1);
  CHECK(tally.worst_ulps == 1);
  tally += counted({2.0f, 0}, {0.0f, 1});
  CHECK(tally.asked == 2);
  CHECK(tally.same_depth == 1);
  CHECK(tally.other_depths == 2);
  CHECK(tally.worst_ulps == 0x40000000u);
  CHECK(counted({2.0f, 0}, {1.0f, 2}).other_depths == 0);
}
