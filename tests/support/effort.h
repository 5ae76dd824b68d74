#pragma once

// How many repetitions a test makes. Under the sanitizers, where a repetition takes ten to forty times as
// long and what is looked for are faults of memory and arithmetic rather than rare cases, a share of them.

namespace plumb::hard {

#if defined(__SANITIZE_ADDRESS__)
inline constexpr unsigned kEffortDivisor = 8;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
inline constexpr unsigned kEffortDivisor = 8;
#else
inline constexpr unsigned kEffortDivisor = 1;
#endif
#else
inline constexpr unsigned kEffortDivisor = 1;
#endif

/// `repetitions`, or under the sanitizers a share of them, at least 1.
template <typename Count>
constexpr Count effort(Count repetitions) {
  const Count share = repetitions / static_cast<Count>(kEffortDivisor);
  return share == 0 ? Count{1} : share;
}

}  // namespace plumb::hard
