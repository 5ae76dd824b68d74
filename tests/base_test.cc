#include <doctest/doctest.h>

#include <atomic>
#include <cmath>
#include <vector>

#include "base/fp_mode.h"
#include "base/parallel.h"
#include "plumb/error.h"
#include "plumb/simd.h"
#include "support/fp_modes.h"

using namespace plumb;

TEST_SUITE("simd") {
  TEST_CASE("every usable target has a name that parses back to it") {
    const std::vector<Simd> targets = simd_targets();
    REQUIRE_FALSE(targets.empty());
    for (const Simd simd : targets) CHECK(parse_simd(simd_name(simd)) == simd);
    CHECK(parse_simd("AUTO") == Simd::Auto);
    CHECK_THROWS_AS(parse_simd("mmx"), Error);
  }
}

TEST_SUITE("parallel") {
  TEST_CASE("every index is visited once, whatever the thread count") {
    for (int threads = 0; threads <= 4; ++threads) {
      std::vector<std::atomic<int>> visits(1000);
      detail::parallel_for(visits.size(), threads, [&](std::size_t i) { ++visits[i]; });
      for (const auto& v : visits) CHECK(v == 1);
    }
  }

  TEST_CASE("an exception of a worker reaches the caller") {
    CHECK_THROWS_AS(detail::parallel_for(100, 2,
                                         [](std::size_t i) {
                                           if (i == 57) throw Error("57");
                                         }),
                    Error);
    CHECK_THROWS_AS(detail::parallel_for(1, -1, [](std::size_t) {}), Error);
  }

  TEST_CASE("workers run under the default floating-point mode") {
    for (const hard::NamedFpMode& mode : hard::kFpModes) {
      CAPTURE(mode.name);
      std::atomic<int> wrong{0};
      hard::under_mode(mode.bits, [&] {
        detail::parallel_for(64, 2, [&](std::size_t) { wrong += detail::fp_mode_is_default() ? 0 : 1; });
      });
      CHECK(wrong == 0);
    }
  }

  TEST_CASE("progress ends at the callback's false") {
    int calls = 0;
    detail::Progress progress(
        [&](double share) {
          ++calls;
          return share < 0.5;
        },
        1000);
    int steps = 0;
    while (steps < 1000 && progress.add(1)) ++steps;
    CHECK(steps < 600);
    CHECK(progress.cancelled());
    CHECK_THROWS_AS(progress.throw_if_cancelled(), Cancelled);
    CHECK(calls > 1);
  }
}
