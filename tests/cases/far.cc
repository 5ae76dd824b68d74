#include "cases/groups.h"
#include "cases/shape.h"
#include "support/hard_scenes.h"

// Narrow views from far away: the directions of neighbouring pixels differ in their last bits only.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Far cameras";

// kSizes times the scene's size away; the frame is about as high as the scene.
template <int kSizes>
void far_camera(Random& random, Instance& instance) {
  const std::string_view scene = one_of(random, {"soup", "terrain", "solid", "fan", "near_ties"});
  instance.mesh = hard::scene_of_kind(random, scene);
  constexpr float kSize = 2.0f;
  const glm::vec3 target = random.pick(instance.mesh.positions);
  glm::vec3 direction = random.unit3();
  direction[random.between(0, 2)] = random.one_in(2) ? 1.0f : -1.0f;
  const glm::vec3 eye = target + kSize * static_cast<float>(kSizes) * direction;
  instance.camera = narrow_camera(eye, target, 0.5 / kSizes);
}

constexpr std::string_view kDefinition =
    "A frame is what the rounded rays see, so a pixel shows what its float direction meets, exactly.";

constexpr Case kCases[] = {
    {kGroup, "camera-1e3", "Frames from a thousand sizes of the scene away.", kDefinition, 3,
     far_camera<1000>},
    {kGroup, "camera-1e4", "Frames from ten thousand sizes of the scene away.", kDefinition, 3,
     far_camera<10'000>},
    {kGroup, "camera-1e5", "Frames from a hundred thousand sizes of the scene away.", kDefinition, 3,
     far_camera<100'000>},
    {kGroup, "camera-1e6", "Frames from a million sizes of the scene away.", kDefinition, 3,
     far_camera<1'000'000>},
};

}  // namespace

std::span<const Case> far_cases() { return kCases; }

}  // namespace plumb::cases
