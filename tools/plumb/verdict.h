#pragma once

#include <optional>
#include <string>
#include <vector>

#include "plumb/frame.h"

namespace plumb::tool {

/// What the process returns: docs/tool.md.
enum ExitStatus : int { kAgree = 0, kDiffer = 1, kBadInput = 2 };

/// How the frames of two runs compare.
struct Pair {
  std::string a, b;  ///< the runs' names
  Comparison comparison;
  std::optional<std::string> picture;  ///< the file that shows where they differ, if one was written
  int layer = 0;                       ///< which one, from 1; 0 where frames have one only
};

/// kAgree when no pair differs in any pixel, else kDiffer.
ExitStatus exit_status(const std::vector<Pair>& pairs);

/// One line: whether b agrees with a, and if not, in how many pixels it differs.
std::string summary(const Pair& pair);

/// A line for each of the first pixels that differ, with what each run saw there, and one for how
/// many more there are. Empty when they agree.
std::string differences(const Pair& pair);

}  // namespace plumb::tool
