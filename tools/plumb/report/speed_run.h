#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "bench/table.h"
#include "encode.h"
#include "plumb/ray.h"
#include "plumb/simd.h"

// Speed against error: every rung of arithmetic, method, width and target, and the peers of this build, timed
// in turns on the same rays, each with how far its answers are from the exact ones.

namespace plumb::tool {

struct SpeedOptions {
  std::vector<std::string> scenes;  ///< builtin:NAME[:SIZE], or files
  int width = 640, height = 360;
  int rounds = 3;
  int threads = 1;
  std::vector<Simd> targets;
};

/// How answers compare with the exact ones.
struct Errors {
  std::uint64_t asked = 0;
  std::uint64_t wrong_ids = 0;  ///< another id or none, or one where there is nothing
  std::uint64_t lost = 0;       ///< of these, nothing where there is something
  std::uint64_t extra = 0;      ///< something where there is nothing
  /// Where the right triangle is seen: how far the depth is from the exact one, in floats.
  std::uint64_t seen_right = 0;
  std::uint64_t other_depths = 0;
  std::uint32_t worst_ulps = 0;
  std::uint32_t ulps_999 = 0;  ///< at most this in 999 of 1000 such answers
  double mean_ulps = 0;

  double wrong_per_million() const {
    return asked == 0 ? 0.0 : 1e6 * static_cast<double>(wrong_ids) / static_cast<double>(asked);
  }
};

/// Compares answers with the exact ones.
Errors errors_of(std::span<const Hit> exact, std::span<const Hit> answers);

/// One method on one instruction set, or a peer.
struct SpeedRow {
  bench::Row row;  ///< its speeds
  Errors camera, diffuse, frame;
};

/// A picture of where a method's frame is wrong.
struct ErrorPicture {
  std::string method;
  std::uint64_t different_pixels;
  Image image;
};

struct SpeedScene {
  std::string title;
  std::size_t triangles;
  std::uint64_t diffuse_rays;
  std::vector<SpeedRow> rows;
  Image depth;  ///< the exact frame
  std::vector<ErrorPicture> pictures;
};

struct SpeedReport {
  SpeedOptions options;
  std::string machine, compiler, peer;  ///< the peer's name and version, empty without one
  std::vector<SpeedScene> scenes;

  /// Whether no exact method differs from the reference.
  bool agrees() const;
};

/// Measures one scene. `progress` is called with the share that is done.
SpeedScene measure_scene(const std::string& scene, const SpeedOptions& options,
                         const std::function<bool(double)>& progress);

/// What the report says: as a table for people, as JSON (docs/tool.md), and as one HTML page that needs no
/// other file, with plots and pictures. The page needs the program gnuplot; without it plumb::Error.
std::string speed_table(const SpeedReport& report);
std::string speed_json(const SpeedReport& report);
std::string speed_page(const SpeedReport& report);

}  // namespace plumb::tool
