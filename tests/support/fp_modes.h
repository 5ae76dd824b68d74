#pragma once

#include <stdexcept>
#include <type_traits>

#include "base/fp_mode.h"

// The floating-point modes that a caller of the library may have set on this machine.

namespace plumb::hard {

struct NamedFpMode {
  const char* name;
  detail::FpMode bits;  ///< of detail::kFpModeBits
};

#if defined(__SSE2__)
inline constexpr NamedFpMode kFpModes[] = {
    {"flush to zero", 0x8000u},
    {"denormals are zero", 0x0040u},
    {"flush to zero, denormals are zero", 0x8040u},
    {"rounding down", 0x2000u},
    {"rounding up", 0x4000u},
    {"rounding toward zero", 0x6000u},
    {"flush to zero, denormals are zero, rounding toward zero", 0xe040u},
};
#elif defined(__aarch64__)
// FZ flushes inputs as well.
inline constexpr NamedFpMode kFpModes[] = {
    {"flush to zero", 1u << 24},
    {"rounding up", 1u << 22},
    {"rounding down", 2u << 22},
    {"rounding toward zero", 3u << 22},
    {"flush to zero, rounding toward zero", (1u << 24) | (3u << 22)},
};
#else
inline constexpr NamedFpMode kFpModes[] = {{"default", 0}};
#endif

/// Of them, the one that differs from the default in everything.
inline constexpr detail::FpMode kOddestFpMode = kFpModes[sizeof kFpModes / sizeof *kFpModes - 1].bits;

/// Sets a mode for its lifetime.
class FpModeGuard {
 public:
  explicit FpModeGuard(detail::FpMode bits) : saved_(detail::fp_mode()), bits_(bits) {
    detail::set_fp_mode((saved_ & ~detail::kFpModeBits) | bits);
  }
  ~FpModeGuard() { detail::set_fp_mode(saved_); }
  FpModeGuard(const FpModeGuard&) = delete;
  FpModeGuard& operator=(const FpModeGuard&) = delete;

  void check_kept() const {
    if ((detail::fp_mode() & detail::kFpModeBits) != bits_) {
      throw std::runtime_error("the caller's floating-point mode was not given back");
    }
  }

 private:
  detail::FpMode saved_;
  detail::FpMode bits_;
};

/// What `work` returns when its caller has set the mode. Throws std::runtime_error where `work` does not
/// leave it as it was.
template <typename Work>
auto under_mode(detail::FpMode bits, const Work& work) {
  const FpModeGuard guard(bits);
  if constexpr (std::is_void_v<decltype(work())>) {
    work();
    guard.check_kept();
  } else {
    auto result = work();
    guard.check_kept();
    return result;
  }
}

}  // namespace plumb::hard
