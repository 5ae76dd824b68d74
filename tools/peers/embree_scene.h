#pragma once

#include <string>
#include <utility>

#include <embree3/rtcore.h>

#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb::peers {

/// "Embree 3.13.5".
std::string embree_version();

/// A device of at most `threads` threads, which may be shared by many scenes. Throws plumb::Error.
class EmbreeDevice {
 public:
  explicit EmbreeDevice(int threads);
  ~EmbreeDevice() { rtcReleaseDevice(device_); }
  EmbreeDevice(const EmbreeDevice& other) : device_(other.device_) { rtcRetainDevice(device_); }
  EmbreeDevice& operator=(EmbreeDevice other) {
    std::swap(device_, other.device_);
    return *this;
  }

  RTCDevice get() const { return device_; }

 private:
  RTCDevice device_;
};

/// A mesh in an Embree scene. Throws plumb::Error where Embree fails.
class EmbreeScene {
 public:
  EmbreeScene(const EmbreeDevice& device, MeshView mesh, bool robust,
              RTCBuildQuality quality = RTC_BUILD_QUALITY_MEDIUM);
  ~EmbreeScene() { rtcReleaseScene(scene_); }
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene get() const { return scene_; }

 private:
  EmbreeDevice device_;
  RTCScene scene_;
};

/// Whether Embree may be asked: with its assertions compiled in, as Debian's are, it aborts on a NaN, on a
/// negative tmin and on an origin or direction beyond 1.844e18.
bool embree_takes(const Ray& ray);

}  // namespace plumb::peers
