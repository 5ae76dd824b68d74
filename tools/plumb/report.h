#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "method.h"
#include "scene.h"
#include "verdict.h"

namespace plumb::tool {

/// What is kept of a run when its frame is gone.
struct RunReport {
  Run run;
  std::optional<double> build_seconds;
  double frame_seconds = 0;
  std::size_t seen_pixels = 0;          ///< pixels that see a triangle
  std::vector<std::string> files;       ///< written with --out
  std::optional<VisibleChoice> choice;  ///< of Method::Auto
};

/// A comparison of several runs on one scene.
struct CompareReport {
  std::vector<RunReport> runs;
  std::vector<Pair> pairs;  ///< each later run against the first, layer by layer
  int layers = 1;           ///< of each frame
};

/// One line: the run's name, padded to `name_width`, and its times.
std::string timing(const RunReport& report, std::size_t name_width);

/// One line: how many frames agree.
std::string verdict(const CompareReport& report);

/// The report as a JSON object, as docs/tool.md describes it.
std::string to_json(const Scene& scene, int threads, const CompareReport& report);

}  // namespace plumb::tool
