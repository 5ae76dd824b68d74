#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/cases.h"
#include "report/answerer.h"
#include "report/tally.h"

namespace plumb::tool {

struct HardOptions {
  std::uint64_t seed = 1;
  std::uint64_t instances = 1000;  ///< of a case of cost 1; others have their share, at least one
  std::string cases;               ///< names with commas between; all, when empty
  std::optional<int> threads;      ///< 0 or nothing: all
};

/// What one was asked of a case.
struct Asked {
  std::uint64_t count = 0;     ///< rays or pixels
  std::uint64_t seen = 0;      ///< those that see something
  std::vector<Tally> tallies;  ///< of each answerer; asked nothing where it was not asked
};

/// How all answerers do at one case.
struct CaseResult {
  const cases::Case* hard_case;
  std::uint64_t instances = 0;
  Asked rays, pixels;
  /// Of plumb's own methods, a few: what differs and how to make it again.
  std::vector<std::string> differences;
};

struct HardReport {
  HardOptions options;
  std::vector<Answerer> answerers;
  std::vector<CaseResult> cases;

  /// All answers of plumb's own methods.
  Tally plumb_total() const;
  /// Whether they are the exact ones.
  bool agrees() const { return plumb_total().different == 0; }
};

/// Asks every answerer everything about one case, on many threads.
CaseResult run_case(const cases::Case& hard_case, const std::vector<Answerer>& answerers,
                    const HardOptions& options, const std::function<bool(double)>& progress);

}  // namespace plumb::tool
