#include "peers/embree_scene.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "peers/flush_mode.h"
#include "plumb/error.h"

namespace plumb::peers {
namespace {

void check_error(RTCDevice device, const char* what) {
  const RTCError error = rtcGetDeviceError(device);
  if (error != RTC_ERROR_NONE) {
    throw Error(std::string("plumb: Embree failed ") + what + ", error " + std::to_string(error));
  }
}

template <typename T>
void copy(RTCGeometry geometry, std::span<const T> from, RTCBufferType type, RTCFormat format) {
  void* const to = rtcSetNewGeometryBuffer(geometry, type, 0, format, sizeof(T), from.size());
  std::copy(from.begin(), from.end(), static_cast<T*>(to));
}

bool in_range(const glm::vec3& v) {
  constexpr float kGreatest = 1.844e18f;
  return std::fabs(v.x) <= kGreatest && std::fabs(v.y) <= kGreatest && std::fabs(v.z) <= kGreatest;
}

}  // namespace

std::string embree_version() { return "Embree " RTC_VERSION_STRING; }

EmbreeDevice::EmbreeDevice(int threads, const std::string& isa)
    : bytes_(std::make_shared<std::atomic<std::ptrdiff_t>>(0)),
      device_(
          rtcNewDevice(("threads=" + std::to_string(threads) + (isa.empty() ? "" : ",isa=" + isa)).c_str())) {
  check_error(device_, "to make a device");
  const auto count = [](void* bytes, ssize_t more, bool) {
    *static_cast<std::atomic<std::ptrdiff_t>*>(bytes) += more;
    return true;
  };
  rtcSetDeviceMemoryMonitorFunction(device_, count, bytes_.get());
}

EmbreeScene::EmbreeScene(const EmbreeDevice& device, MeshView mesh, bool robust, RTCBuildQuality quality)
    : device_(device) {
  const FlushMode flush;
  scene_ = rtcNewScene(device_.get());
  rtcSetSceneFlags(scene_, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
  rtcSetSceneBuildQuality(scene_, quality);
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  copy(geometry, mesh.positions, RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT3);
  copy(geometry, mesh.triangles, RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT3);
  rtcSetGeometryBuildQuality(geometry, quality);
  rtcCommitGeometry(geometry);
  const std::size_t before = device_.bytes();
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
  bytes_ = device_.bytes() - before;
  check_error(device_.get(), "to build");
}

bool embree_takes(const Ray& ray) {
  return in_range(ray.origin) && in_range(ray.direction) && ray.tmin >= 0.0f && !std::isnan(ray.tmax);
}

}  // namespace plumb::peers
