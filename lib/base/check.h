#pragma once

#include <sstream>
#include <string>

#include "plumb/error.h"

// PLUMB_CHECK_EQ etc. are always on and throw plumb::Error with both values: for what must hold
// between stages. PLUMB_DCHECK is for inner loops and gone in release builds.

namespace plumb::detail {

template <typename A, typename B>
[[noreturn]] void check_failed(const char* file, int line, const char* text, const A& a, const B& b) {
  std::ostringstream message;
  message << "plumb: internal check failed at " << file << ":" << line << ": " << text << " (" << a
          << " against " << b << "); please report this";
  throw Error(message.str());
}

}  // namespace plumb::detail

#define PLUMB_CHECK_OP(a, op, b)                                                                          \
  do {                                                                                                    \
    const auto& plumb_check_a = (a);                                                                      \
    const auto& plumb_check_b = (b);                                                                      \
    if (!(plumb_check_a op plumb_check_b)) {                                                              \
      ::plumb::detail::check_failed(__FILE__, __LINE__, #a " " #op " " #b, plumb_check_a, plumb_check_b); \
    }                                                                                                     \
  } while (false)
#define PLUMB_CHECK_EQ(a, b) PLUMB_CHECK_OP(a, ==, b)
#define PLUMB_CHECK_LE(a, b) PLUMB_CHECK_OP(a, <=, b)
#define PLUMB_CHECK_LT(a, b) PLUMB_CHECK_OP(a, <, b)

#if defined(NDEBUG)
#define PLUMB_DCHECK(condition) static_cast<void>(0)
#else
#define PLUMB_DCHECK(condition)                                                            \
  do {                                                                                     \
    if (!(condition)) ::plumb::detail::check_failed(__FILE__, __LINE__, #condition, 0, 1); \
  } while (false)
#endif
