#include "pixels/tile_state.h"

#include "exact/intersect.h"
#include "scene/pixel_direction.h"

namespace plumb::detail {
namespace {

glm::vec3 direction(const TileTask& task, int offset) {
  return pixel_direction(task.camera, task.x + tile_x(offset), task.y + tile_y(offset));
}

Triangle corners(const TileTask& task, std::uint32_t triangle) {
  const glm::uvec3& c = task.mesh.triangles[triangle];
  return {task.mesh.positions[c.x], task.mesh.positions[c.y], task.mesh.positions[c.z]};
}

}  // namespace

void learn_pixel(const TileTask& task, TileState& state, int offset) {
  const std::uint32_t triangle = state.winner[offset];
  state.known[offset] = triangle;
  state.t[offset] = line_depth(task.camera.eye, direction(task, offset), corners(task, triangle));
  state.id[offset] = task.first_id + triangle;
}

bool decide_pixel(const TileTask& task, TileState& state, int offset, std::uint32_t triangle) {
  if (!(state.t[offset] > 0.0f)) return false;  // outside the frame, or nothing can be nearer
  Ray ray;
  ray.origin = task.camera.eye;
  ray.direction = direction(task, offset);
  if (task.exact_only && !ray_is_valid(ray)) return false;
  float t = 0.0f;
  if (!line_hit(ray.origin, ray.direction, corners(task, triangle), t) || !depth_counts(ray, t)) return false;
  const std::uint32_t id = task.first_id + triangle;
  if (!hit_before(t, id, {state.t[offset], state.id[offset]})) return false;
  state.winner[offset] = state.known[offset] = triangle;
  state.t[offset] = t;
  state.id[offset] = id;
  return true;
}

}  // namespace plumb::detail
