#pragma once

#include <bit>
#include <cstdint>

// Four floats in a register on every target, by GCC's and Clang's vector extension: for code such as
// tree builders that handles one box or point at a time. Kernels that want as many lanes as the
// machine has use Highway instead. Operators work lane by lane and round as the scalar ones do.

namespace plumb::detail {

using Float4 = float __attribute__((vector_size(16)));
using Int4 = std::int32_t __attribute__((vector_size(16)));

inline Float4 splat(float value) { return Float4{value, value, value, value}; }
inline Int4 splat(std::int32_t value) { return Int4{value, value, value, value}; }

/// The second where either is NaN.
inline Float4 min(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max(Float4 a, Float4 b) { return a > b ? a : b; }

/// Lane by lane, `a` where the mask is all ones and `b` where it is zero.
inline Float4 select(Int4 mask, Float4 a, Float4 b) {
  return std::bit_cast<Float4>((mask & std::bit_cast<Int4>(a)) | (~mask & std::bit_cast<Int4>(b)));
}
inline Int4 select(Int4 mask, Int4 a, Int4 b) { return (mask & a) | (~mask & b); }

inline Int4 truncate(Float4 a) { return __builtin_convertvector(a, Int4); }
inline Float4 to_float(Int4 a) { return __builtin_convertvector(a, Float4); }

}  // namespace plumb::detail
