#include <memory>
#include <span>

#include <tbb/task_arena.h>

#include "peers/embree_calls.h"
#include "peers/embree_scene.h"
#include "peers/flush_mode.h"
#include "report/answerer.h"

namespace plumb::tool {
namespace {

std::vector<std::optional<Hit>> closest(const peers::EmbreeScene& scene, std::span<const Ray> rays) {
  std::vector<std::optional<Hit>> hits(rays.size());
  const peers::FlushMode flush;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (peers::embree_takes(rays[i])) peers::closest_one(scene.get(), context, rays[i], hits[i].emplace());
  }
  return hits;
}

Answers answer(const peers::EmbreeDevice& device, bool robust, const cases::Instance& instance) {
  const std::vector<Ray> pixels = cases::pixel_rays(instance);
  // While Embree waits for its own tasks, no other of ours may start: the oracle wants the default
  // floating-point mode.
  return tbb::this_task_arena::isolate([&] {
    const peers::EmbreeScene scene(device, instance.mesh, robust);
    return Answers{closest(scene, instance.rays), closest(scene, pixels)};
  });
}

}  // namespace

std::vector<Answerer> embree_answerers() {
  // As many threads as Embree likes: a number would hold for all of the process.
  const peers::EmbreeDevice device(0);
  std::vector<Answerer> answerers;
  for (const bool robust : {false, true}) {
    answerers.push_back(
        {robust ? "embree-robust" : "embree-fast", "", peers::embree_version(),
         robust
             ? "the same in robust mode, where a hit exactly at tmin counts"
             : "its single-ray call, with flush-to-zero on as its manual asks; not asked about rays on which "
               "it aborts (NaN, components beyond 1.8e18, tmin below 0)",
         [=](const cases::Instance& instance) { return answer(device, robust, instance); }});
  }
  return answerers;
}

}  // namespace plumb::tool
