#include "plumb/visible_triangles.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

#include "plumb/ray.h"

namespace plumb {
namespace {

// A counter for each id is faster than sorting while there are at most so many for each pixel.
constexpr std::size_t kCountersAPixel = 2;

struct Seen {
  std::size_t pixels = 0;         // that see something
  std::uint32_t greatest_id = 0;  // of what they see
};

Seen seen_by(std::span<const Frame> frames) {
  Seen seen;
  for (const Frame& frame : frames) {
    for (const std::uint32_t id : frame.id) {
      if (id == kNone) continue;
      ++seen.pixels;
      seen.greatest_id = std::max(seen.greatest_id, id);
    }
  }
  return seen;
}

std::vector<VisibleTriangle> counted(std::span<const Frame> frames, std::uint32_t greatest_id) {
  std::vector<std::uint32_t> pixels(std::size_t{greatest_id} + 1);
  std::vector<std::uint64_t> rounds;  // of a counter that ran over, made when one does
  for (const Frame& frame : frames) {
    for (const std::uint32_t id : frame.id) {
      if (id == kNone || ++pixels[id] != 0) continue;
      rounds.resize(pixels.size());
      ++rounds[id];
    }
  }
  std::vector<VisibleTriangle> triangles;
  for (std::uint32_t id = 0; id <= greatest_id; ++id) {
    const std::uint64_t count = pixels[id] + (rounds.empty() ? 0 : rounds[id] << 32);
    if (count != 0) triangles.push_back({id, count});
  }
  return triangles;
}

std::vector<VisibleTriangle> sorted(std::span<const Frame> frames, std::size_t pixels) {
  std::vector<std::uint32_t> ids;
  ids.reserve(pixels);
  for (const Frame& frame : frames)
    std::copy_if(frame.id.begin(), frame.id.end(), std::back_inserter(ids),
                 [](std::uint32_t id) { return id != kNone; });
  std::sort(ids.begin(), ids.end());
  std::vector<VisibleTriangle> triangles;
  for (const std::uint32_t id : ids) {
    if (triangles.empty() || triangles.back().id != id) triangles.push_back({id, 0});
    ++triangles.back().pixels;
  }
  return triangles;
}

}  // namespace

std::vector<VisibleTriangle> visible_triangles(std::span<const Frame> frames) {
  const Seen seen = seen_by(frames);
  if (seen.pixels == 0) return {};
  return seen.greatest_id / kCountersAPixel < seen.pixels ? counted(frames, seen.greatest_id)
                                                          : sorted(frames, seen.pixels);
}

std::vector<VisibleTriangle> visible_triangles(const Frame& frame) { return visible_triangles({&frame, 1}); }

}  // namespace plumb
