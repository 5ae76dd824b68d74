#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>

#include <glm/vec3.hpp>

#include "io/ply_header.h"

namespace plumb::detail {

/// Where x, y and z are in rows of equal length, and of which types.
struct VertexRow {
  std::size_t bytes = sizeof(glm::vec3);
  std::array<std::size_t, 3> at = {0, 4, 8};
  std::array<PlyType, 3> type = {PlyType::Float32, PlyType::Float32, PlyType::Float32};
  bool swapped = false;  // the byte order is not this machine's
};

/// Reads the vertices of ascending numbers, each coordinate rounded once to the nearest float, in runs that
/// fit the buffer: none is read twice, and gaps that are wide are not read. `read(offset, to, bytes)` is
/// asked for offsets from that of vertex 0.
void gather_vertices(const std::function<void(std::uint64_t, char*, std::size_t)>& read, const VertexRow& row,
                     std::span<const std::uint32_t> numbers, std::span<char> buffer, glm::vec3* to);

}  // namespace plumb::detail
