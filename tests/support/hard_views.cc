#include "support/hard_views.h"

#include <cstdio>

#include "support/hard_cameras.h"
#include "support/hard_scenes.h"
#include "support/oracle_adapter.h"

namespace plumb::hard {
namespace {

View make_view(const SceneKind& scene, const CameraKind& kind, std::uint64_t seed) {
  Random random(seed);
  TriangleMesh mesh = scene.make(random);
  const Camera camera = kind.make(random, mesh);
  const std::string name =
      std::string(scene.name) + " from " + std::string(kind.name) + ", seed " + std::to_string(seed);
  Frame expected = witness::oracle_frame(mesh, camera);
  return {name, std::move(mesh), camera, std::move(expected)};
}

}  // namespace

std::vector<View> make_views(std::uint64_t count, std::uint64_t first_seed) {
  std::vector<View> result;
  std::uint64_t seed = first_seed;
  for (const SceneKind& scene : scene_kinds()) {
    for (const CameraKind& kind : camera_kinds()) {
      for (std::uint64_t i = 0; i < count; ++i) {
        result.push_back(make_view(scene, kind, seed++));
      }
    }
  }
  return result;
}

const std::vector<View>& views() {
  static const std::vector<View> made = make_views(2);
  return made;
}

std::string difference(const Frame& frame, const Frame& expected) {
  const Comparison comparison = compare(frame, expected);
  if (comparison.equal()) return "";
  const PixelDifference& p = comparison.first.front();
  char text[200];
  std::snprintf(text, sizeof text, "%zu pixels, first (%d, %d): (%a, %u) for (%a, %u)",
                comparison.different_pixels, p.x, p.y, double{p.depth_a}, p.id_a, double{p.depth_b}, p.id_b);
  return text;
}

}  // namespace plumb::hard
