#pragma once

#include <cfloat>

// The one place where a double becomes a float that decides something: docs/visibility.md's RN32.
//
// The cast is all there is to it where the compiler obeys. GCC 12's SLP vectorizer does not: of two
// such casts whose results are stored side by side as doubles it makes a plain copy, unrounded. The
// library is therefore compiled with -fno-tree-slp-vectorize (cmake/PlumbTarget.cmake), and
// tests/rounding_test.cc shows that the flag does its work. Round through this function, so that what
// the test shows holds for every rounding of the library.

static_assert(FLT_EVAL_METHOD == 0,
              "plumb needs float and double arithmetic that rounds to its own type (SSE2, not x87)");

namespace plumb::detail {

/// The nearest float, ties to even; infinite from 2^128 - 2^103 on. The caller holds the default
/// floating-point mode (base/fp_mode.h).
inline float round_to_float(double value) { return static_cast<float>(value); }

}  // namespace plumb::detail
