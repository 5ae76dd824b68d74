#include "color.h"

#include <algorithm>
#include <cmath>

namespace plumb::tool {
namespace {

// IEC 61966-2-1: linear light to an 8-bit sRGB value.
std::uint8_t to_srgb(float linear) {
  const float x = std::clamp(linear, 0.0f, 1.0f);
  const float encoded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1.0f / 2.4f) - 0.055f;
  return static_cast<std::uint8_t>(std::lround(255.0f * encoded));
}

float cube(float x) { return x * x * x; }

}  // namespace

Rgb oklch(float lightness, float chroma, float hue) {
  const float a = chroma * std::cos(hue);
  const float b = chroma * std::sin(hue);
  // The constants are Ottosson's: Oklab to cone responses, these to linear sRGB.
  const float l = cube(lightness + 0.3963377774f * a + 0.2158037573f * b);
  const float m = cube(lightness - 0.1055613458f * a - 0.0638541728f * b);
  const float s = cube(lightness - 0.0894841775f * a - 1.2914855480f * b);
  return {to_srgb(4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s),
          to_srgb(-1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s),
          to_srgb(-0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s)};
}

}  // namespace plumb::tool
