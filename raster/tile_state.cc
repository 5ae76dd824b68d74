#include "raster/tile_state.h"

#include <algorithm>

namespace plumb::detail {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

}  // namespace

TileState::TileState(const TileTask& task, TilePixels& pixels) : task_(task), pixels_(pixels) {
  std::fill(std::begin(index), std::end(index), kEarlier);
  std::fill(std::begin(known_), std::end(known_), kEarlier);
  const bool whole = task.x + kTilePx <= task.camera.width && task.y + kTilePx <= task.camera.height;
  for (int offset = 0; offset < kTilePixels; ++offset) {
    if (whole || in_frame(offset)) {
      set_bounds(offset, pixels.t[offset]);
    } else {
      inverse_low[offset] = inverse_high[offset] = kInfinity;
    }
  }
  for (int block = 0; block < kTileBlocks * kTileBlocks; ++block) update_block(block);
}

// t is RN32 of the exact t, so 1/t is off by 2^-24 of itself and the division by another; 2^-21 also
// leaves more than the spacing of floats, so that what is beyond rounds to another t.
void TileState::set_bounds(int offset, float t) {
  if (t == kInfinity) {
    inverse_low[offset] = -kInfinity;
    inverse_high[offset] = kLeastInverse;
    return;
  }
  const float inverse = 1.0f / t;
  const bool usable = inverse > kLeastInverse && inverse < kGreatestInverse;
  inverse_low[offset] = usable ? inverse * (1.0f - 0x1p-21f) : -kInfinity;
  inverse_high[offset] = usable ? inverse * (1.0f + 0x1p-21f) : kInfinity;
}

Hit TileState::nearest(int offset) {
  const std::uint32_t triangle = index[offset];
  if (triangle == kEarlier) return {pixels_.t[offset], pixels_.id[offset]};
  if (known_[offset] != triangle) {
    known_[offset] = triangle;
    known_t_[offset] = line_depth(task_.camera.eye, direction(offset), triangle_at(triangle));
    set_bounds(offset, known_t_[offset]);
  }
  return {known_t_[offset], task_.first_id + triangle};
}

void TileState::decide(int offset, std::uint32_t triangle) {
  if (!in_frame(offset)) return;
  Ray ray;
  ray.origin = task_.camera.eye;
  ray.direction = direction(offset);
  if (task_.exact_only && !ray_is_valid(ray)) return;
  float t = 0.0f;
  if (!line_hit(ray.origin, ray.direction, triangle_at(triangle), t) || !depth_counts(ray, t)) return;
  if (!hit_before(t, task_.first_id + triangle, nearest(offset))) return;
  index[offset] = known_[offset] = triangle;
  known_t_[offset] = t;
  set_bounds(offset, t);
}

void TileState::update_block(int block) {
  const float* low = inverse_low + block * kBlockPixels;
  block_low[block] = *std::min_element(low, low + kBlockPixels);
}

void TileState::finish() {
  for (int offset = 0; offset < kTilePixels; ++offset) {
    if (index[offset] == kEarlier) continue;
    const Hit hit = nearest(offset);
    pixels_.t[offset] = hit.t;
    pixels_.id[offset] = hit.id;
  }
}

}  // namespace plumb::detail
