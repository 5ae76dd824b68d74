#pragma once

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace plumb::peers {

/// Flush-to-zero and denormals-are-zero on this thread while it lives, as Embree's manual asks. plumb is
/// timed in the default mode, and so must not run inside.
class FlushMode {
 public:
  FlushMode(const FlushMode&) = delete;
  FlushMode& operator=(const FlushMode&) = delete;

#if defined(__SSE2__)
  FlushMode() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | kFtzAndDaz); }
  ~FlushMode() { _mm_setcsr(saved_); }

 private:
  static constexpr unsigned kFtzAndDaz = 0x8040;
  unsigned saved_;
#elif defined(__aarch64__)
  FlushMode() {
    asm volatile("mrs %0, fpcr" : "=r"(saved_));
    asm volatile("msr fpcr, %0" : : "r"(saved_ | kFz));
  }
  ~FlushMode() { asm volatile("msr fpcr, %0" : : "r"(saved_)); }

 private:
  static constexpr unsigned long kFz = 1ul << 24;
  unsigned long saved_;
#else
#error "How does this processor flush subnormals to zero?"
#endif
};

}  // namespace plumb::peers
