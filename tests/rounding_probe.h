#pragma once

#include <cstddef>

#include "plumb/simd.h"

// Small functions compiled by plumb_library(), as all of the library is: rounding_test.cc shows by
// them that the compiler neither fuses nor drops a rounding there.

namespace plumb::probe {

/// a[i] * b[i] - c[i] * d[i], in the kernels' way of being compiled for one target: once by Highway's
/// Mul and Sub, once in scalar code. `count` is a multiple of kProbeCount.
inline constexpr std::size_t kProbeCount = 64;
template <typename T>
struct Products {
  const T *a, *b, *c, *d;
  T *by_highway, *by_scalars;
  std::size_t count;
};
void subtract_products(Simd simd, const Products<float>& products);
void subtract_products(Simd simd, const Products<double>& products);

/// The same in code for the machine that the library as a whole is compiled for.
float subtract_products(float a, float b, float c, float d);
double subtract_products(double a, double b, double c, double d);

/// Rounds to float and gives back as doubles, in the forms in which GCC 12's SLP vectorizer drops the
/// rounding: neighbours in memory read, rounded and stored in sequence.
void round_pair(const double* in, double* out);
void round_triple(const double* in, double* out);
void round_four(const double* in, double* out);

}  // namespace plumb::probe
