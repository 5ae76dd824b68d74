#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>

namespace plumb::detail {

/// The number whose bytes begin at `at`. kSwap: the file's byte order is not this machine's.
template <typename T, bool kSwap>
T load_binary(const char* at) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if constexpr (kSwap) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

}  // namespace plumb::detail
