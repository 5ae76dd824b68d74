#pragma once

#include <bit>
#include <cmath>
#include <cstdint>

#include <glm/vec3.hpp>

namespace plumb::hard {

/// The Fowler-Noll-Vo hash, FNV-1a, of 64 bits, over 32-bit words. Floats count as their bits, so that -0
/// is not 0; all NaNs are alike, because machines make different ones.
class Hash {
 public:
  void add(std::uint32_t word) { value_ = (value_ ^ word) * 0x100000001b3u; }

  void add(std::uint64_t word) {
    add(static_cast<std::uint32_t>(word));
    add(static_cast<std::uint32_t>(word >> 32));
  }

  void add(float f) { add(std::isnan(f) ? 0x7fc00000u : std::bit_cast<std::uint32_t>(f)); }
  void add(double d) { add(std::isnan(d) ? 0x7ff8000000000000u : std::bit_cast<std::uint64_t>(d)); }

  template <typename T, glm::qualifier Q>
  void add(const glm::vec<3, T, Q>& v) {
    for (int axis = 0; axis < 3; ++axis) add(v[axis]);
  }

  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace plumb::hard
