#pragma once

#include <string>
#include <vector>

#include "plumb/simd.h"
#include "scene.h"

namespace plumb::bench {

/// What the command line asks for, apart from Google Benchmark's own flags.
struct Options {
  bool help = false;
  bool peers = false;                ///< the table, with the peer's best as the baseline
  std::vector<std::string> methods;  ///< the tasks' methods; empty: all
  std::vector<std::string> works;    ///< names of the tasks' works; empty: all
  bool table = false;                ///< the Markdown table instead of Google Benchmark
  int width = 1280, height = 720;
  int rounds = 5;            ///< of the table
  std::vector<int> threads;  ///< each at least 1
  std::vector<Simd> targets;
  std::string peer_isa;  ///< for Embree; empty: all that the machine has
  std::vector<ViewName> views;
};

/// Throws plumb::Error for an argument that it does not know or cannot use.
Options parse_options(int argc, const char* const* argv);

extern const char* const kUsage;

}  // namespace plumb::bench
