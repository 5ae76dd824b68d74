#pragma once

#include <cstdint>

#if defined(__FAST_MATH__)
#error "plumb decides by exact arithmetic: compile it without -ffast-math (-Ofast)"
#endif

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

// The floating-point mode: rounding direction, flush-to-zero, denormals-are-zero. The answer is
// defined for round-to-nearest with subnormals, and many renderers run with other modes, so every
// public call runs its work under the default mode and gives the caller's back.

namespace plumb::detail {

#if defined(__SSE2__)
using FpMode = std::uint32_t;
inline constexpr FpMode kFpModeBits = 0xe040u;  // FTZ, both rounding bits, DAZ of MXCSR
inline FpMode fp_mode() { return _mm_getcsr(); }
inline void set_fp_mode(FpMode mode) { _mm_setcsr(mode); }
#elif defined(__aarch64__)
using FpMode = std::uint64_t;
// FZ, RMode, FZ16 of FPCR; and of FEAT_AFP, for those who run x86 code, FIZ (flush inputs) and AH.
inline constexpr FpMode kFpModeBits = (1u << 24) | (3u << 22) | (1u << 19) | 3u;
inline FpMode fp_mode() {
  FpMode mode;
  asm volatile("mrs %0, fpcr" : "=r"(mode));
  return mode;
}
inline void set_fp_mode(FpMode mode) { asm volatile("msr fpcr, %0" : : "r"(mode)); }
#else
using FpMode = std::uint32_t;  // WebAssembly and others: only the default mode exists
inline constexpr FpMode kFpModeBits = 0;
inline FpMode fp_mode() { return 0; }
inline void set_fp_mode(FpMode) {}
#endif

inline bool fp_mode_is_default() { return (fp_mode() & kFpModeBits) == 0; }

/// Sets the default mode for its lifetime and puts the caller's back.
class DefaultFpMode {
 public:
  DefaultFpMode() : saved_(fp_mode()) { set_fp_mode(saved_ & ~kFpModeBits); }
  ~DefaultFpMode() { set_fp_mode(saved_); }
  DefaultFpMode(const DefaultFpMode&) = delete;
  DefaultFpMode& operator=(const DefaultFpMode&) = delete;

 private:
  FpMode saved_;
};

/// Calls `work` under the default mode. `work` must do its arithmetic in functions that are not
/// inlined here, for the compiler knows nothing of the mode and may move arithmetic across the
/// switch; the noinline wrapper sees to that.
template <typename Work>
[[gnu::noinline]] auto call_not_inlined(const Work& work) {
  return work();
}

template <typename Work>
inline auto with_default_fp_mode(const Work& work) {
  if (fp_mode_is_default()) [[likely]] {
    return work();
  }
  const DefaultFpMode guard;
  return call_not_inlined(work);
}

}  // namespace plumb::detail
