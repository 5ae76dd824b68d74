#include "rounding_probe.h"

#include "base/round.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "rounding_probe.cc"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

// After foreach_target.h, which must come before the first highway.h.
#include "base/simd_dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace plumb::probe::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <typename T>
HWY_INLINE void SubtractByScalars(const Products<T>& p, T* result) {
  for (std::size_t i = 0; i < p.count; ++i) result[i] = p.a[i] * p.b[i] - p.c[i] * p.d[i];
}

template <typename T>
HWY_INLINE void SubtractByHighway(const Products<T>& p) {
  const hn::ScalableTag<T> tag;
  for (std::size_t i = 0; i < p.count; i += hn::Lanes(tag)) {
    const auto left = hn::Mul(hn::LoadU(tag, p.a + i), hn::LoadU(tag, p.b + i));
    const auto right = hn::Mul(hn::LoadU(tag, p.c + i), hn::LoadU(tag, p.d + i));
    hn::StoreU(hn::Sub(left, right), tag, p.by_highway + i);
  }
}

void SubtractFloats(const Products<float>& p) {
  SubtractByHighway(p);
  SubtractByScalars(p, p.by_scalars);
}

void SubtractDoubles(const Products<double>& p) {
#if HWY_HAVE_FLOAT64
  SubtractByHighway(p);
#else
  SubtractByScalars(p, p.by_highway);  // this target has no vectors of doubles
#endif
  SubtractByScalars(p, p.by_scalars);
}

}  // namespace plumb::probe::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace plumb::probe {

HWY_EXPORT(SubtractFloats);
HWY_EXPORT(SubtractDoubles);

void subtract_products(Simd simd, const Products<float>& products) {
  PLUMB_DISPATCH(SubtractFloats, simd)(products);
}

void subtract_products(Simd simd, const Products<double>& products) {
  PLUMB_DISPATCH(SubtractDoubles, simd)(products);
}

float subtract_products(float a, float b, float c, float d) { return a * b - c * d; }
double subtract_products(double a, double b, double c, double d) { return a * b - c * d; }

void round_pair(const double* in, double* out) {
  const float x = detail::round_to_float(in[0]), y = detail::round_to_float(in[1]);
  out[0] = double{x};
  out[1] = double{y};
}

void round_triple(const double* in, double* out) {
  const float x = detail::round_to_float(in[0]), y = detail::round_to_float(in[1]);
  const float z = detail::round_to_float(in[2]);
  out[0] = double{x};
  out[1] = double{y};
  out[2] = double{z};
}

void round_four(const double* in, double* out) {
  float rounded[4];
  for (int i = 0; i < 4; ++i) rounded[i] = detail::round_to_float(in[i]);
  for (int i = 0; i < 4; ++i) out[i] = double{rounded[i]};
}

}  // namespace plumb::probe
#endif  // HWY_ONCE
