#include "picture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "color.h"
#include "plumb/ray.h"

namespace plumb::tool {
namespace {

constexpr Rgb kBackground = {232, 232, 228};

Image blank(const Frame& frame) {
  const std::size_t pixels = static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height);
  return {frame.width, frame.height, std::vector<std::uint8_t>(3 * pixels)};
}

void set_pixel(Image& image, std::size_t pixel, const Rgb& color) {
  std::copy(color.begin(), color.end(), image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * pixel));
}

/// The natural logarithm of each depth: what perspective makes smaller by a factor is darker by a step.
std::vector<float> log_depths(const Frame& frame) {
  std::vector<float> logs(frame.depth.size());
  std::transform(frame.depth.begin(), frame.depth.end(), logs.begin(), [](float t) { return std::log(t); });
  return logs;
}

struct Range {
  float least, greatest;
};

/// What all but the nearest and the farthest 1 in 200 of the pixels that see something span, so that a
/// stray triangle does not take the contrast from the rest.
Range usual_range(const Frame& frame, const std::vector<float>& logs) {
  std::vector<float> seen;
  seen.reserve(logs.size());
  for (std::size_t i = 0; i < logs.size(); ++i) {
    if (frame.id[i] != kNone) seen.push_back(logs[i]);
  }
  if (seen.empty()) return {0.0f, 1.0f};
  const auto rank = [&](std::size_t index) {
    std::nth_element(seen.begin(), seen.begin() + static_cast<std::ptrdiff_t>(index), seen.end());
    return seen[index];
  };
  const std::size_t tail = seen.size() / 200;
  const float least = rank(tail);
  const float greatest = rank(seen.size() - 1 - tail);
  return {least, std::max(greatest, least + 1e-3f)};
}

/// How bright the surface is under a light from the upper left, 0 to 1. Depth changes by d(log t) a
/// pixel, and a pixel spans about 1 / height of the distance, so that the quotient is the slope.
class Relief {
 public:
  Relief(const Frame& frame, const std::vector<float>& logs) : frame_(frame), logs_(logs) {}

  float operator()(int x, int y) const {
    const float height = static_cast<float>(frame_.height);
    const float slope_x = height * step(x, y, 1, 0);
    const float slope_y = height * step(x, y, 0, 1);
    const float length = std::sqrt(slope_x * slope_x + slope_y * slope_y + 1.0f);
    // The surface's normal is (slope_x, slope_y, 1) with z towards the eye; the light is (-1, -1, 1.5),
    // in pixels' axes, y down.
    const float lambert = (1.5f - slope_x - slope_y) / (length * std::sqrt(4.25f));
    return std::clamp(lambert, 0.0f, 1.0f);
  }

 private:
  bool seen(int x, int y) const {
    return x >= 0 && y >= 0 && x < frame_.width && y < frame_.height && frame_.id[index(x, y)] != kNone;
  }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.width) + static_cast<std::size_t>(x);
  }

  /// The smaller of the changes to the pixels before and after, along (dx, dy): the one that is more
  /// likely to stay on the surface.
  float step(int x, int y, int dx, int dy) const {
    const float here = logs_[index(x, y)];
    const bool has_before = seen(x - dx, y - dy);
    const bool has_after = seen(x + dx, y + dy);
    const float before = has_before ? here - logs_[index(x - dx, y - dy)] : 0.0f;
    const float after = has_after ? logs_[index(x + dx, y + dy)] - here : 0.0f;
    if (!has_before) return after;
    if (!has_after) return before;
    return std::abs(before) < std::abs(after) ? before : after;
  }

  const Frame& frame_;
  const std::vector<float>& logs_;
};

/// Calls paint(pixel, farness, relief) for each pixel that sees something; farness is 0 to 1.
template <typename Paint>
void for_each_seen(const Frame& frame, const Paint& paint) {
  const std::vector<float> logs = log_depths(frame);
  const Range range = usual_range(frame, logs);
  const Relief relief(frame, logs);
  std::size_t pixel = 0;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x, ++pixel) {
      if (frame.id[pixel] == kNone) continue;
      const float farness = (logs[pixel] - range.least) / (range.greatest - range.least);
      paint(pixel, std::clamp(farness, 0.0f, 1.0f), relief(x, y));
    }
  }
}

/// A well mixed hash of 32 bits: C. Wellons, "Prospecting for Hash Functions", 2018 (lowbias32).
std::uint32_t hash(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  x ^= x >> 16;
  return x;
}

Rgb id_color(std::uint32_t id) {
  if (id == kNone) return kBackground;
  const std::uint32_t bits = hash(id);
  const float hue = static_cast<float>(bits & 0xffffu) * (2.0f * std::numbers::pi_v<float> / 65536.0f);
  const float lightness = 0.60f + 0.28f * static_cast<float>((bits >> 16) & 0xffu) / 255.0f;
  const float chroma = 0.05f + 0.08f * static_cast<float>(bits >> 24) / 255.0f;
  return oklch(lightness, chroma, hue);
}

/// Yellow, orange, red, violet, blue: both lightness and hue fall with distance.
Rgb depth_color(float farness, float relief) {
  const float lightness = (0.95f - 0.56f * farness) * (0.62f + 0.38f * relief);
  const float hue = 1.75f - 3.25f * farness;
  const float chroma = 0.10f + 0.16f * farness * (1.0f - farness);
  return oklch(lightness, chroma, hue);
}

constexpr Rgb kIdDiffers = {226, 24, 30};
constexpr Rgb kDepthDiffers = {255, 150, 0};
constexpr Rgb kRing = {20, 20, 20};
constexpr int kRingRadius = 2;

bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

bool differs(const Frame& a, const Frame& b, std::size_t pixel) {
  return a.id[pixel] != b.id[pixel] || !same_bits(a.depth[pixel], b.depth[pixel]);
}

void draw_ring(Image& image, int x, int y) {
  const int x_end = std::min(x + kRingRadius, image.width - 1);
  const int y_end = std::min(y + kRingRadius, image.height - 1);
  for (int v = std::max(y - kRingRadius, 0); v <= y_end; ++v) {
    for (int u = std::max(x - kRingRadius, 0); u <= x_end; ++u) {
      set_pixel(
          image,
          static_cast<std::size_t>(v) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(u),
          kRing);
    }
  }
}

}  // namespace

Image depth_picture(const Frame& frame) {
  Image image = blank(frame);
  for (std::size_t i = 0; i < frame.id.size(); ++i) set_pixel(image, i, kBackground);
  for_each_seen(frame, [&](std::size_t pixel, float farness, float relief) {
    set_pixel(image, pixel, depth_color(farness, relief));
  });
  return image;
}

Image id_picture(const Frame& frame) {
  Image image = blank(frame);
  for (std::size_t i = 0; i < frame.id.size(); ++i) set_pixel(image, i, id_color(frame.id[i]));
  return image;
}

Image difference_picture(const Frame& a, const Frame& b) {
  Image image = blank(a);
  for (std::size_t i = 0; i < a.id.size(); ++i) set_pixel(image, i, kBackground);
  for_each_seen(a, [&](std::size_t pixel, float farness, float relief) {
    set_pixel(image, pixel, oklch((0.95f - 0.25f * farness) * (0.75f + 0.25f * relief), 0.0f, 0.0f));
  });
  std::size_t pixel = 0;
  for (int y = 0; y < a.height; ++y) {
    for (int x = 0; x < a.width; ++x, ++pixel) {
      if (differs(a, b, pixel)) draw_ring(image, x, y);
    }
  }
  for (pixel = 0; pixel < a.id.size(); ++pixel) {
    if (!differs(a, b, pixel)) continue;
    set_pixel(image, pixel, a.id[pixel] != b.id[pixel] ? kIdDiffers : kDepthDiffers);
  }
  return image;
}

}  // namespace plumb::tool
