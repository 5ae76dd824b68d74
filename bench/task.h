#pragma once

#include <cstddef>
#include <functional>
#include <iterator>
#include <memory>
#include <string>

#include "rays.h"
#include "scene.h"
#include "shelf.h"

namespace plumb::bench {

/// What a method is asked to do.
enum class Work { Camera, Shadow, Occlusion, Diffuse, Random, Frame, Build };
inline constexpr Work kWorks[] = {Work::Camera, Work::Shadow, Work::Occlusion, Work::Diffuse,
                                  Work::Random, Work::Frame,  Work::Build};
inline constexpr std::size_t kWorkCount = std::size(kWorks);

inline const char* work_name(Work work) {
  constexpr const char* kNames[kWorkCount] = {"camera", "shadow", "occlusion", "diffuse",
                                              "random", "frame",  "build"};
  return kNames[static_cast<std::size_t>(work)];
}

/// One thing to time: a method at a view, on a number of threads.
struct Task {
  std::string method;  ///< "bvh8", "bvh8-fast", "raster", "embree-fast-16"
  std::string target;  ///< the instruction set, where one is chosen
  Work work;
  bool exact;  ///< every answer must be the reference's
  /// Makes all that `run` needs, runs it once and counts the answers that are not the reference's: of
  /// an exact method every bit counts, of others only the triangle and whether there is one.
  std::function<std::size_t()> check;
  /// Does the work once; returns how many rays, pixels or triangles that was.
  std::function<std::size_t()> run;
  /// Of a build: bytes that the structure keeps, after check().
  std::function<std::size_t()> bytes = nullptr;
};

/// What all tasks at a view share.
struct Context {
  ViewName name;
  int threads;                                          ///< at least 1
  std::size_t trees;                                    ///< how many trees of a kind to keep
  std::string peer_isa;                                 ///< the most that the peer may use; empty: anything
  std::function<std::shared_ptr<Workload>()> workload;  ///< makes it when first asked for
};

}  // namespace plumb::bench
