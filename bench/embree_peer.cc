#include "embree_peer.h"

#include <algorithm>
#include <memory>
#include <span>
#include <type_traits>

#include "chunks.h"
#include "peers/embree_calls.h"
#include "peers/embree_scene.h"
#include "peers/flush_mode.h"

namespace plumb::bench {
namespace {

using peers::EmbreeScene;
using peers::FlushMode;

// Embree's scenes of one kind.
struct Source {
  Context context;
  std::shared_ptr<Shelf<EmbreeScene>> scenes;
  bool robust;
  RTCBuildQuality quality;

  std::string mode() const {
    const std::string mode = robust ? "embree-robust" : "embree-fast";
    return quality == RTC_BUILD_QUALITY_LOW    ? mode + "-low"
           : quality == RTC_BUILD_QUALITY_HIGH ? mode + "-high"
                                               : mode;
  }
  std::shared_ptr<EmbreeScene> scene(const Workload& workload) const {
    return scenes->get(context.name.title() + "/" + mode(), [&] {
      return std::make_shared<EmbreeScene>(peers::EmbreeDevice(context.threads, context.peer_isa),
                                           workload.view.mesh, robust, quality);
    });
  }
};

template <int N, typename Answer>
void trace_part(RTCScene scene, bool coherent, std::span<const Ray> rays, Answer* answers) {
  constexpr bool kClosest = std::is_same_v<Answer, Hit>;
  const FlushMode flush;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  for (std::size_t i = 0; i < rays.size(); i += static_cast<std::size_t>(N)) {
    const std::span<const Ray> packet =
        rays.subspan(i, std::min(static_cast<std::size_t>(N), rays.size() - i));
    if constexpr (N == 1 && kClosest) peers::closest_one(scene, context, packet[0], answers[i]);
    if constexpr (N == 1 && !kClosest) peers::any_one(scene, context, packet[0], answers[i]);
    if constexpr (N > 1 && kClosest) peers::closest_packet<N>(scene, context, packet, answers + i);
    if constexpr (N > 1 && !kClosest) peers::any_packet<N>(scene, context, packet, answers + i);
  }
}

std::size_t wrong(const RaySet<Hit>& set) { return other_triangles(set); }
std::size_t wrong(const RaySet<bool>& set) { return differences(set); }

// Camera and shadow rays are marked coherent, as they are and as packets want it; the others are not.
template <int N, typename Set>
Task ray_task(const Source& source, Work work, Set Workload::*set) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    const std::shared_ptr<EmbreeScene> scene = source.scene(*workload);
    Set& rays = (*workload).*set;
    in_chunks(rays.rays.size(), source.context.threads, [&](std::size_t first, std::size_t count) {
      trace_part<N>(scene->get(), work == Work::Camera || work == Work::Shadow,
                    std::span<const Ray>(rays.rays).subspan(first, count), &rays.answers[first]);
    });
    return rays.rays.size();
  };
  const auto check = [=] {
    Set& rays = (*source.context.workload()).*set;
    spoil(rays);
    run();
    return wrong(rays);
  };
  return {source.mode() + "-" + std::to_string(N), "", work, false, check, run};
}

template <int N>
void add_ray_tasks(const Source& source, std::vector<Task>& tasks) {
  tasks.push_back(ray_task<N>(source, Work::Camera, &Workload::camera));
  tasks.push_back(ray_task<N>(source, Work::Shadow, &Workload::shadow));
  tasks.push_back(ray_task<N>(source, Work::Occlusion, &Workload::occlusion));
  tasks.push_back(ray_task<N>(source, Work::Diffuse, &Workload::diffuse));
  tasks.push_back(ray_task<N>(source, Work::Random, &Workload::random));
}

// From the mesh to a scene ready for rays, the device and the copy of the mesh included: what plumb's
// constructor does.
Task build_task(const Source& source) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    const EmbreeScene scene(peers::EmbreeDevice(source.context.threads, source.context.peer_isa),
                            workload->view.mesh, source.robust, source.quality);
    return workload->view.mesh.triangles.size();
  };
  const auto check = [=] {
    run();
    return std::size_t{0};
  };
  const auto bytes = [=] {
    return EmbreeScene(peers::EmbreeDevice(source.context.threads, source.context.peer_isa),
                       source.context.workload()->view.mesh, source.robust, source.quality)
        .bytes();
  };
  return {source.mode() + "-1", "", Work::Build, false, check, run, bytes};
}

}  // namespace

std::vector<Task> embree_tasks(const Context& context) {
  std::vector<Task> tasks;
  const auto scenes = std::make_shared<Shelf<EmbreeScene>>(context.trees);
  for (const RTCBuildQuality quality :
       {RTC_BUILD_QUALITY_MEDIUM, RTC_BUILD_QUALITY_HIGH, RTC_BUILD_QUALITY_LOW}) {
    const Source source{context, scenes, false, quality};
    tasks.push_back(build_task(source));
    if (quality == RTC_BUILD_QUALITY_LOW) continue;
    add_ray_tasks<1>(source, tasks);
    add_ray_tasks<4>(source, tasks);
    add_ray_tasks<8>(source, tasks);
    add_ray_tasks<16>(source, tasks);
  }
  const Source robust{context, scenes, true, RTC_BUILD_QUALITY_MEDIUM};
  add_ray_tasks<1>(robust, tasks);
  add_ray_tasks<16>(robust, tasks);
  return tasks;
}

std::string embree_version() { return peers::embree_version(); }

}  // namespace plumb::bench
