#pragma once

#include <array>
#include <cstdint>

namespace plumb::tool {

using Rgb = std::array<std::uint8_t, 3>;

/// A colour by lightness (0 black to 1 white), chroma (0 grey to about 0.3) and hue (radians) in
/// Oklab, where equal steps look equally large (B. Ottosson, "A perceptual color space for image
/// processing", 2020). Colours that sRGB cannot show are clipped.
Rgb oklch(float lightness, float chroma, float hue);

}  // namespace plumb::tool
