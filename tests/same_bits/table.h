#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace plumb::same_bits {

/// What every machine, compiler, instruction set, width and number of threads must give: hashes
/// (support/hash.h) of the entry's scenes, rays and cameras; of what its rays see (t and id of the closest
/// and of all hits, any hit, and surface() of the closest); and of its frames (depth and id of each pixel).
struct Row {
  std::string_view name;
  std::uint64_t inputs, rays, frames;
};

/// A row for each of entries(). same_bits_test writes it anew where a scene was changed on purpose, and says
/// how when a hash differs.
std::span<const Row> table();

}  // namespace plumb::same_bits
