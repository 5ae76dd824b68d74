#include "pixels/tile_state.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <limits>

#include "scene/pixel_direction.h"

namespace plumb::detail {
namespace {

glm::vec3 direction(const TileView& view, int offset) {
  return pixel_direction(view.camera, view.x + tile_x(offset), view.y + tile_y(offset));
}

}  // namespace

void learn_pixel(const TileView& view, TileState& state, int offset, const PlacedTriangle& winner) {
  state.t[offset] = line_depth(view.camera.eye, direction(view, offset), winner.corners);
  state.id[offset] = winner.id;
}

bool decide_pixel(const TileView& view, TileState& state, int offset, const PlacedTriangle& triangle) {
  if (!(state.t[offset] > 0.0f)) return false;  // outside the frame, or nothing can be nearer
  Ray ray;
  ray.origin = view.camera.eye;
  ray.direction = direction(view, offset);
  if (view.exact_only && !ray_is_valid(ray)) return false;
  float t = 0.0f;
  if (!line_hit(ray.origin, ray.direction, triangle.corners, t) || !depth_counts(ray, t)) return false;
  if (!hit_before(t, triangle.id, {state.t[offset], state.id[offset]})) return false;
  state.winner[offset] = triangle.place;
  state.t[offset] = t;
  state.id[offset] = triangle.id;
  return true;
}

void decide_entry(const TileView& view, LayeredTile& tile, int offset, const PlacedTriangle& triangle) {
  if (!(tile.t[offset] > 0.0f)) return;  // outside the frame, or nothing can be nearer
  Ray ray;
  ray.origin = view.camera.eye;
  ray.direction = direction(view, offset);
  if (view.exact_only && !ray_is_valid(ray)) return;
  float t = 0.0f;
  if (line_hit(ray.origin, ray.direction, triangle.corners, t) && depth_counts(ray, t))
    add_entry(tile, offset, t, triangle.id);
}

void add_entry(LayeredTile& tile, int offset, float t, std::uint32_t id) {
  const std::size_t layers = tile.layers;
  float* const depths = tile.depths.data() + static_cast<std::size_t>(offset) * layers;
  std::uint32_t* const ids = tile.ids.data() + static_cast<std::size_t>(offset) * layers;
  // A triangle whose side is open is drawn twice, and a pixel on its edge may see it both times.
  std::size_t place = layers;
  while (place > 0 && hit_before(t, id, {depths[place - 1], ids[place - 1]})) --place;
  if (place == layers || (place > 0 && depths[place - 1] == t && ids[place - 1] == id)) return;
  std::copy_backward(depths + place, depths + layers - 1, depths + layers);
  std::copy_backward(ids + place, ids + layers - 1, ids + layers);
  depths[place] = t;
  ids[place] = id;
  tile.t[offset] = depths[layers - 1];
}

namespace {

// Calls copy(entry of the frame, entry of the tile, offset in the tile) for the pixels that the tile has in
// the frame.
template <typename Copy>
void for_entries(const TileView& view, std::size_t layers, const Copy& copy) {
  const int columns = std::min(kTilePx, view.camera.width - view.x);
  const int rows = std::min(kTilePx, view.camera.height - view.y);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const std::size_t pixel =
          static_cast<std::size_t>(view.y + y) * static_cast<std::size_t>(view.camera.width) +
          static_cast<std::size_t>(view.x + x);
      const auto offset = static_cast<std::size_t>(tile_offset(x, y));
      copy(pixel * layers, offset * layers, offset);
    }
  }
}

}  // namespace

void load_entries(const TileView& view, const LayeredFrame& frame, LayeredTile& tile) {
  tile.layers = static_cast<std::size_t>(frame.layers);
  tile.depths.assign(kTilePixels * tile.layers, -std::numeric_limits<float>::infinity());
  tile.ids.assign(kTilePixels * tile.layers, 0);
  std::fill(std::begin(tile.t), std::end(tile.t), -std::numeric_limits<float>::infinity());
  for_entries(view, tile.layers, [&](std::size_t from, std::size_t to, std::size_t offset) {
    std::copy_n(frame.depth.data() + from, tile.layers, tile.depths.data() + to);
    std::copy_n(frame.id.data() + from, tile.layers, tile.ids.data() + to);
    tile.t[offset] = tile.depths[to + tile.layers - 1];
  });
}

void store_entries(const TileView& view, const LayeredTile& tile, LayeredFrame& frame) {
  for_entries(view, tile.layers, [&](std::size_t to, std::size_t from, std::size_t) {
    std::copy_n(tile.depths.data() + from, tile.layers, frame.depth.data() + to);
    std::copy_n(tile.ids.data() + from, tile.layers, frame.id.data() + to);
  });
}

}  // namespace plumb::detail
