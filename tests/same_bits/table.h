#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace plumb::same_bits {

/// What every machine, compiler, instruction set, width, quality and number of threads must give, as hashes
/// (support/hash.h).
struct Row {
  std::string_view name;
  std::uint64_t inputs;      ///< the entry's scenes, rays and cameras
  std::uint64_t rays;        ///< t and id of the closest and of all hits, any hit, surface() of the closest
  std::uint64_t frames;      ///< depth and id of each pixel
  std::uint64_t fast;        ///< as rays, without surface(), by Arithmetic::Fast; may differ by quality
  std::uint64_t watertight;  ///< as fast, by Arithmetic::Watertight
};

/// A row for each of entries(). same_bits_test writes it anew where a scene was changed on purpose, and says
/// how when a hash differs.
std::span<const Row> table();

}  // namespace plumb::same_bits
