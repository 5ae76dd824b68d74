#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "base/round.h"
#include "plumb/simd.h"
#include "rounding_probe.h"

// Shows that the flags of plumb_exact_arithmetic() reach what plumb_library() compiles and do their
// work: without -ffp-contract=off or -fno-tree-slp-vectorize the first suite or the second fails, with
// the compilers that have these habits (docs/visibility.md).

using namespace plumb;

namespace {

// Random numbers with full mantissas, so that most products are inexact.
template <typename T>
std::vector<T> numbers(std::uint32_t seed, std::size_t count) {
  std::mt19937_64 random(seed);
  std::vector<T> result(count);
  for (T& value : result) {
    const std::uint64_t mantissa = random() >> (64 - std::numeric_limits<T>::digits);
    value = static_cast<T>(mantissa) * static_cast<T>(random() % 2 == 0 ? 0x1p-20 : -0x1p-20);
  }
  return result;
}

// a * b - c * d with equal products, told in another order: c = b and d = a.
template <typename T>
void check_equal_products_cancel(Simd simd) {
  const std::size_t count = 16 * probe::kProbeCount;
  const std::vector<T> a = numbers<T>(1, count), b = numbers<T>(2, count);
  std::vector<T> by_highway(count, T{1}), by_scalars(count, T{1});
  probe::subtract_products(simd, probe::Products<T>{a.data(), b.data(), b.data(), a.data(), by_highway.data(),
                                                    by_scalars.data(), count});
  CAPTURE(simd_name(simd));
  std::size_t highway_wrong = 0, scalars_wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    highway_wrong += by_highway[i] == T{0} ? 0 : 1;
    scalars_wrong += by_scalars[i] == T{0} ? 0 : 1;
  }
  CHECK(highway_wrong == 0);
  CHECK(scalars_wrong == 0);
}

// How many of `n` doubles in a row were not rounded as a volatile float rounds them.
template <std::size_t n>
std::size_t count_unrounded(void (*round)(const double*, double*)) {
  const std::vector<double> in = numbers<double>(3, n * 256);
  std::vector<double> out(in.size(), 0.0);
  for (std::size_t i = 0; i < in.size(); i += n) round(in.data() + i, out.data() + i);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < in.size(); ++i) {
    const volatile float rounded = static_cast<float>(in[i]);
    wrong += out[i] == double{rounded} ? 0 : 1;
  }
  return wrong;
}

}  // namespace

TEST_SUITE("rounding: contraction") {
  TEST_CASE("equal products cancel to exactly 0 on every target, by Highway and in scalar code") {
    for (const Simd simd : simd_targets()) {
      check_equal_products_cancel<float>(simd);
      check_equal_products_cancel<double>(simd);
    }
  }

  TEST_CASE("equal products cancel to exactly 0 in code for the baseline") {
    const std::vector<float> f = numbers<float>(4, 256);
    const std::vector<double> d = numbers<double>(5, 256);
    for (std::size_t i = 0; i + 1 < f.size(); ++i) {
      CHECK(probe::subtract_products(f[i], f[i + 1], f[i + 1], f[i]) == 0.0f);
      CHECK(probe::subtract_products(d[i], d[i + 1], d[i + 1], d[i]) == 0.0);
    }
  }
}

TEST_SUITE("rounding: to float") {
  TEST_CASE("doubles rounded and stored in sequence are all rounded") {
    CHECK(count_unrounded<2>(probe::round_pair) == 0);
    CHECK(count_unrounded<3>(probe::round_triple) == 0);
    CHECK(count_unrounded<4>(probe::round_four) == 0);
  }

  TEST_CASE("ties go to even, overflow to infinity, and subnormal floats are kept") {
    CHECK(detail::round_to_float(1.0 + 0x1p-24) == 1.0f);
    CHECK(detail::round_to_float(1.0 + 0x1.8p-23) == 1.0f + 0x1p-22f);
    CHECK(detail::round_to_float(1.0 + 0x1p-24 + 0x1p-52) == 1.0f + 0x1p-23f);
    CHECK(detail::round_to_float(0x1.fffffefffffffp+127) == std::numeric_limits<float>::max());
    CHECK(detail::round_to_float(0x1.ffffffp+127) == std::numeric_limits<float>::infinity());
    CHECK(detail::round_to_float(0x1.8p-150) == 0x1p-149f);
    CHECK(detail::round_to_float(0x1p-150) == 0.0f);
  }
}
