#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>

#include <embree3/rtcore.h>

#include "plumb/mesh.h"
#include "plumb/ray.h"

namespace plumb::peers {

/// "Embree 3.13.5".
std::string embree_version();

/// A device of at most `threads` threads, which may be shared by many scenes. `isa` is what Embree's own
/// configuration calls the most that it may use ("sse4.2", "avx2"); empty: all that the machine has. Throws
/// plumb::Error.
class EmbreeDevice {
 public:
  explicit EmbreeDevice(int threads, const std::string& isa = "");
  ~EmbreeDevice() { rtcReleaseDevice(device_); }
  EmbreeDevice(const EmbreeDevice& other) : bytes_(other.bytes_), device_(other.device_) {
    rtcRetainDevice(device_);
  }
  EmbreeDevice& operator=(EmbreeDevice other) {
    std::swap(bytes_, other.bytes_);
    std::swap(device_, other.device_);
    return *this;
  }

  RTCDevice get() const { return device_; }
  /// What Embree has taken and not given back.
  std::size_t bytes() const { return static_cast<std::size_t>(bytes_->load()); }

 private:
  std::shared_ptr<std::atomic<std::ptrdiff_t>> bytes_;
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
  /// What building took and kept of a device that has only this scene: the tree and its triangles, without
  /// the copy of the mesh.
  std::size_t bytes() const { return bytes_; }

 private:
  EmbreeDevice device_;
  std::size_t bytes_ = 0;
  RTCScene scene_;
};

/// Whether Embree may be asked: with its assertions compiled in, as Debian's are, it aborts on a NaN, on a
/// negative tmin and on an origin or direction beyond 1.844e18.
bool embree_takes(const Ray& ray);

}  // namespace plumb::peers
