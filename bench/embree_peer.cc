#include "embree_peer.h"

#include <algorithm>
#include <memory>
#include <span>
#include <type_traits>

#include "chunks.h"
#include "embree_calls.h"
#include "flush_mode.h"
#include "plumb/error.h"

namespace plumb::bench {
namespace {

void check_error(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) {
    throw Error(std::string("plumb_bench: Embree failed ") + what + ", error " + std::to_string(error));
  }
}

// A mesh in an Embree scene, with a device of as many threads as are allowed.
class EmbreeScene {
 public:
  EmbreeScene(const TriangleMesh& mesh, bool robust, int threads)
      : device_(rtcNewDevice(("threads=" + std::to_string(threads)).c_str())) {
    check_error(device_, "to make a device");
    const FlushMode flush;
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_MEDIUM);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    copy(geometry, mesh.positions, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3);
    copy(geometry, mesh.triangles, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
    check_error(device_, "to build");
  }
  ~EmbreeScene() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene get() const { return scene_; }

 private:
  template <typename T>
  static void copy(RTCGeometry geometry, const std::vector<T>& from, RTCBufferType type, RTCFormat format) {
    void* const to = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), from.size());
    std::copy(from.begin(), from.end(), static_cast<T*>(to));
  }

  RTCDevice device_;
  RTCScene scene_;
};

// Embree's scenes of one kind.
struct Source {
  Context context;
  std::shared_ptr<Shelf<EmbreeScene>> scenes;
  bool robust;

  std::string mode() const { return robust ? "embree-robust" : "embree-fast"; }
  std::shared_ptr<EmbreeScene> scene(const Workload& workload) const {
    return scenes->get(context.name.title() + "/" + mode(), [&] {
      return std::make_shared<EmbreeScene>(workload.view.mesh, robust, context.threads);
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
    if constexpr (N == 1 && kClosest) closest_one(scene, context, packet[0], answers[i]);
    if constexpr (N == 1 && !kClosest) any_one(scene, context, packet[0], answers[i]);
    if constexpr (N > 1 && kClosest) closest_packet<N>(scene, context, packet, answers + i);
    if constexpr (N > 1 && !kClosest) any_packet<N>(scene, context, packet, answers + i);
  }
}

std::size_t wrong(const RaySet<Hit>& set) { return other_triangles(set); }
std::size_t wrong(const RaySet<bool>& set) { return differences(set); }

// Camera and shadow rays are marked coherent, as they are and as packets want it.
template <int N, typename Set>
Task ray_task(const Source& source, Work work, Set Workload::*set) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    const std::shared_ptr<EmbreeScene> scene = source.scene(*workload);
    Set& rays = (*workload).*set;
    in_chunks(rays.rays.size(), source.context.threads, [&](std::size_t first, std::size_t count) {
      trace_part<N>(scene->get(), work != Work::Diffuse,
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
  tasks.push_back(ray_task<N>(source, Work::Diffuse, &Workload::diffuse));
}

// From the mesh to a scene ready for rays, the device and the copy of the mesh included: what plumb's
// constructor does.
Task build_task(const Source& source) {
  const auto run = [=] {
    const std::shared_ptr<Workload> workload = source.context.workload();
    const EmbreeScene scene(workload->view.mesh, source.robust, source.context.threads);
    return workload->view.mesh.triangles.size();
  };
  const auto check = [=] {
    run();
    return std::size_t{0};
  };
  return {source.mode() + "-1", "", Work::Build, false, check, run};
}

}  // namespace

std::vector<Task> embree_tasks(const Context& context) {
  std::vector<Task> tasks;
  const auto scenes = std::make_shared<Shelf<EmbreeScene>>(context.trees);
  for (const bool robust : {false, true}) {
    const Source source{context, scenes, robust};
    add_ray_tasks<1>(source, tasks);
    add_ray_tasks<8>(source, tasks);
    add_ray_tasks<16>(source, tasks);
    tasks.push_back(build_task(source));
  }
  return tasks;
}

std::string embree_version() { return "Embree " RTC_VERSION_STRING; }

}  // namespace plumb::bench
