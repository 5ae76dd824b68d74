#pragma once

#include <cstdint>

#include <glm/vec3.hpp>

#include "exact/intersect.h"
#include "wide/triangle_block.h"

namespace plumb::detail {

/// A wide tree's triangles as tiles are drawn from them (pixels/tile_settle-inl.h): lane i of block b is
/// triangle W b + i.
template <int W>
struct TreeTriangles {
  const TriangleBlock<W>* blocks;

  std::uint32_t id(std::uint32_t index) const { return blocks[index / W].id[index % W]; }
  Triangle corners(std::uint32_t index) const {
    const TriangleBlock<W>& block = blocks[index / W];
    const auto corner = [&](int v) {
      return glm::vec3(block.vertex[v][0][index % W], block.vertex[v][1][index % W],
                       block.vertex[v][2][index % W]);
    };
    return {corner(0), corner(1), corner(2)};
  }
};

}  // namespace plumb::detail
