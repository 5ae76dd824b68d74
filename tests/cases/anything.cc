#include <utility>

#include "cases/groups.h"
#include "support/hard_cameras.h"
#include "support/hard_rays.h"
#include "support/hard_scenes.h"

// Everything crossed with everything.

namespace plumb::cases {
namespace {

constexpr std::string_view kGroup = "Everything crossed";

const hard::SceneKind& any_scene(hard::Random& random) {
  const std::span<const hard::SceneKind> kinds = hard::scene_kinds();
  return kinds[random.below(static_cast<std::uint32_t>(kinds.size()))];
}

void any_ray(hard::Random& random, Instance& instance) {
  constexpr std::size_t kRays = 16;
  const hard::SceneKind& scene = any_scene(random);
  hard::Case made = hard::make_case(scene, random.bits(), kRays);
  instance.mesh = std::move(made.mesh);
  instance.rays = std::move(made.rays);
}

void any_camera(hard::Random& random, Instance& instance) {
  instance.mesh = any_scene(random).make(random);
  const std::span<const hard::CameraKind> cameras = hard::camera_kinds();
  instance.camera =
      cameras[random.below(static_cast<std::uint32_t>(cameras.size()))].make(random, instance.mesh);
}

constexpr Case kCases[] = {
    {kGroup, "any-ray",
     "All kinds of small scenes and of rays that the tests know (tests/support), in any combination, with "
     "stretched directions, nudged floats and odd limits.",
     "There is one definition and no special case.", 1, any_ray},
    {kGroup, "any-frame", "The same scenes and all kinds of cameras, in any combination.",
     "There is one definition and no special case.", 5, any_camera},
};

}  // namespace

std::span<const Case> anything_cases() { return kCases; }

}  // namespace plumb::cases
