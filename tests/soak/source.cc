#include "soak/source.h"

#include <span>

#include "support/hard_cameras.h"
#include "support/hard_rays.h"
#include "support/hard_scenes.h"
#include "support/random.h"

namespace plumb::soak {
namespace {

constexpr std::size_t kRays = 160;

std::string place(std::uint64_t seed, std::uint64_t index) {
  return ", seed " + std::to_string(seed) + ", instance " + std::to_string(index);
}

// A scene of any kind with rays of any kind, and for one in four a camera of any kind too.
Drawn mixed(std::uint64_t seed, std::uint64_t index) {
  hard::Random random(seed ^ hard::Random(index).bits());
  const hard::SceneKind& scene =
      hard::scene_kinds()[random.below(static_cast<std::uint32_t>(hard::scene_kinds().size()))];
  hard::Case made = hard::make_case(scene, random.bits(), kRays);
  const std::string kind = "scene " + std::string(scene.name);
  Drawn drawn{kind, kind + place(seed, index), {std::move(made.mesh), std::move(made.rays), {}}};
  if (index / 2 % 4 == 0) {
    const auto kinds = hard::camera_kinds();
    const hard::CameraKind& camera = kinds[random.below(static_cast<std::uint32_t>(kinds.size()))];
    drawn.instance.camera = camera.make(random, drawn.instance.mesh);
  }
  return drawn;
}

}  // namespace

Drawn draw_instance(std::uint64_t seed, std::uint64_t index) {
  const std::span<const cases::Case> all = cases::all_cases();
  const std::uint64_t half = index / 2;
  if (index % 2 == 1) return mixed(seed, index);
  // A costly case takes its turn less often.
  const cases::Case& hard_case = all[half % all.size()];
  const std::uint64_t turn = half / all.size();
  if (turn % hard_case.cost != 0) return mixed(seed, index);
  const std::string kind = "case " + std::string(hard_case.name);
  return {kind, kind + place(seed, turn / hard_case.cost),
          cases::make_instance(hard_case, seed, turn / hard_case.cost)};
}

}  // namespace plumb::soak
