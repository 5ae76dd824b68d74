#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "plumb/camera.h"
#include "plumb/frame.h"
#include "plumb/mesh.h"

namespace plumb::hard {

/// A small hard scene, a hard camera and the frame that the oracle sees.
struct View {
  std::string name;
  TriangleMesh mesh;
  Camera camera;
  Frame expected;
};

/// `count` views for every pair of a kind of scene and a kind of camera, their seeds from `first_seed` on.
std::vector<View> make_views(std::uint64_t count, std::uint64_t first_seed = 1);

/// Two of every pair, made once.
const std::vector<View>& views();

/// Where the frame first differs from what is expected, and in how many pixels; "" where it does not.
std::string difference(const Frame& frame, const Frame& expected);

}  // namespace plumb::hard
