#include "pixels/tile_state.h"

#include <algorithm>
#include <cstddef>
#include <limits>

#include "scene/pixel_direction.h"

namespace plumb::detail {
namespace {

glm::vec3 direction(const TileView& view, int offset) {
  return pixel_direction(view.camera, view.x + tile_x(offset), view.y + tile_y(offset));
}

}  // namespace

void learn_pixel(const TileView& view, TileState& state, int offset, const PlacedTriangle& winner) {
  state.known[offset] = winner.place;
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
  state.winner[offset] = state.known[offset] = triangle.place;
  state.t[offset] = t;
  state.id[offset] = triangle.id;
  return true;
}

void clear_tile(const TileView& view, Frame& frame) {
  const int columns = std::min(kTilePx, view.camera.width - view.x);
  const int rows = std::min(kTilePx, view.camera.height - view.y);
  for (int y = view.y; y < view.y + rows; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(view.camera.width) +
                              static_cast<std::size_t>(view.x);
    std::fill_n(frame.depth.data() + first, columns, std::numeric_limits<float>::infinity());
    std::fill_n(frame.id.data() + first, columns, kNone);
  }
}

}  // namespace plumb::detail
