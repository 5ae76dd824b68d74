#include "cases/cases.h"

#include <algorithm>

#include "cases/groups.h"

namespace plumb::cases {
namespace {

std::vector<Case> joined() {
  std::vector<Case> all;
  for (const std::span<const Case> group :
       {edge_cases(), plane_cases(), shape_cases(), depth_cases(), coincident_cases(), origin_cases(),
        far_cases(), range_cases(), tree_cases(), anything_cases()}) {
    all.insert(all.end(), group.begin(), group.end());
  }
  return all;
}

// The Fowler-Noll-Vo hash, FNV-1a, of 64 bits: a case's instances do not depend on its place in the list.
std::uint64_t hash(std::string_view text) {
  std::uint64_t result = 0xcbf29ce484222325u;
  for (const char c : text) result = (result ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return result;
}

}  // namespace

std::span<const Case> all_cases() {
  static const std::vector<Case> all = joined();
  return all;
}

const Case* find_case(std::string_view name) {
  const std::span<const Case> all = all_cases();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Case& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Instance make_instance(const Case& hard_case, std::uint64_t seed, std::uint64_t index) {
  // Each step mixes what came before into the next state.
  std::uint64_t state = hard::Random(seed).bits() ^ hash(hard_case.name);
  state = hard::Random(state).bits() ^ index;
  hard::Random random(hard::Random(state).bits());
  Instance instance;
  hard_case.make(random, instance);
  return instance;
}

std::vector<Ray> pixel_rays(const Instance& instance) {
  std::vector<Ray> rays;
  if (!instance.camera) return rays;
  for (int y = 0; y < instance.camera->height; ++y) {
    for (int x = 0; x < instance.camera->width; ++x) rays.push_back(instance.camera->ray(x, y));
  }
  return rays;
}

}  // namespace plumb::cases
