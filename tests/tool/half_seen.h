#pragma once

#include <cstddef>

#include "plumb/frame.h"

namespace plumb::test {

inline constexpr int kWidth = 20, kHeight = 10;

/// A frame that sees one triangle in the lower half, and nothing above.
inline Frame half_seen() {
  Frame frame(kWidth, kHeight);
  for (std::size_t i = kWidth * kHeight / 2; i < kWidth * kHeight; ++i) {
    frame.depth[i] = 2.0f + static_cast<float>(i % kWidth) * 0.125f;
    frame.id[i] = 7;
  }
  return frame;
}

inline std::size_t at(int x, int y) {
  return static_cast<std::size_t>(y) * kWidth + static_cast<std::size_t>(x);
}

}  // namespace plumb::test
