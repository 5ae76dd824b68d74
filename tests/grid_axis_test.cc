#include <doctest/doctest.h>

#include <gmpxx.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "structures/grid_scene.h"
#include "support/random.h"

using plumb::detail::GridAxis;
using plumb::hard::Random;

TEST_SUITE("grid axis") {
  // GridRay's proof wants that index() is monotonic and that plane() is off by less than slack().
  TEST_CASE("cells begin where plane() says, to within slack()") {
    Random random(1);
    int beyond_plane = 0;
    for (int i = 0; i < 2000; ++i) {
      const int scale = random.between(-140, 120);
      const float a = std::ldexp(random.unit(), scale);
      const float b =
          random.one_in(2) ? a + std::ldexp(random.unit(), scale - 12) : std::ldexp(random.unit(), scale);
      if (a == b) continue;
      const GridAxis axis =
          GridAxis::cut(std::min(a, b), std::max(a, b), random.between(2, 1 << random.between(1, 20)));
      CHECK(axis.index(axis.lo) == 0);
      CHECK(axis.index(axis.hi) == axis.cells - 1);
      for (int k = 0; k < 50; ++k) {
        const int cell = random.between(1, axis.cells - 1);
        const double plane = axis.plane(cell), slack = axis.slack();
        // Surely before, surely behind, and in between whatever it is.
        CHECK(axis.index(plane - slack) < cell);
        CHECK(axis.index(plane + slack) >= cell);
        double x = plane;
        for (int step = 0; step < 4; ++step) {
          const double next = std::nextafter(x, std::numeric_limits<double>::infinity());
          CHECK(axis.index(next) >= axis.index(x));
          x = next;
        }
        beyond_plane += axis.index(plane) < cell ? 1 : 0;
      }
    }
    // The slack is there for something.
    CHECK(beyond_plane > 1000);
  }
}
