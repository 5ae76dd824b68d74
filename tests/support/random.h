#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <glm/vec3.hpp>

namespace plumb::hard {

/// SplitMix64 (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators"): the same
/// numbers on every machine and with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t bits() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

  /// Below `count`, which is at least 1.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>(((bits() >> 32) * count) >> 32);
  }

  int between(int least, int greatest) {
    return least + static_cast<int>(below(static_cast<std::uint32_t>(greatest - least + 1)));
  }

  bool one_in(std::uint32_t count) { return below(count) == 0; }

  /// From -1 up to 1, a multiple of 2^-23.
  float unit() {
    return static_cast<float>(static_cast<std::int32_t>(below(1u << 24)) - (1 << 23)) * 0x1p-23f;
  }

  /// Each component from -1 up to 1.
  glm::vec3 unit3() {
    const float x = unit(), y = unit(), z = unit();
    return {x, y, z};
  }

  /// Integers from -limit to limit.
  glm::vec3 lattice3(int limit) {
    const int x = between(-limit, limit), y = between(-limit, limit), z = between(-limit, limit);
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
  }

  template <typename T>
  const T& pick(const std::vector<T>& from) {
    return from[below(static_cast<std::uint32_t>(from.size()))];
  }

  template <typename T>
  void shuffle(std::vector<T>& items) {
    for (std::size_t i = items.size(); i > 1; --i) {
      std::swap(items[i - 1], items[below(static_cast<std::uint32_t>(i))]);
    }
  }

 private:
  std::uint64_t state_;
};

}  // namespace plumb::hard
