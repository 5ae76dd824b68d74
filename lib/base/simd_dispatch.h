#pragma once

// How a kernel is chosen: privately, without Highway's global state. A file of kernels exports one
// function per target with HWY_EXPORT(F) and calls it as PLUMB_DISPATCH(F, simd)(arguments), where
// `simd` has gone through `resolve_simd`.

#include <cstddef>
#include <cstdint>

#include "hwy/highway.h"
#include "plumb/simd.h"

namespace plumb::detail {

/// Auto becomes the best target; one that this machine lacks throws plumb::Error.
Simd resolve_simd(Simd simd);

/// The HWY_* bit of a target (not Auto).
std::int64_t highway_target(Simd simd);

inline std::size_t dispatch_index(Simd simd) {
  hwy::ChosenTarget chosen;
  chosen.Update(highway_target(simd));
  return chosen.GetIndex();
}

}  // namespace plumb::detail

#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0
// One target only: Highway makes no table.
#define PLUMB_DISPATCH(F, simd) (*HWY_DISPATCH_TABLE(F)[0])
#else
#define PLUMB_DISPATCH(F, simd) (*HWY_DISPATCH_TABLE(F)[::plumb::detail::dispatch_index(simd)])
#endif
