#include <nlohmann/json.hpp>

#include "plumb/version.h"
#include "report/hard_document.h"

namespace plumb::tool {
namespace {

using nlohmann::json;

// Without those that were asked nothing.
json answers_json(const Asked& asked, const std::vector<Answerer>& answerers) {
  json answers = json::array();
  for (std::size_t i = 0; i < answerers.size(); ++i) {
    const Tally& tally = asked.tallies[i];
    if (tally.asked == 0) continue;
    answers.push_back({{"method", answerers[i].method},
                       {"simd", answerers[i].simd.empty() ? json() : json(answerers[i].simd)},
                       {"asked", tally.asked},
                       {"different", tally.different},
                       {"wrong_ids", tally.wrong_ids},
                       {"lost", tally.lost},
                       {"extra", tally.extra},
                       {"other_surface", tally.other_surface},
                       {"same_depth", tally.same_depth},
                       {"other_depths", tally.other_depths},
                       {"worst_ulps", tally.worst_ulps}});
  }
  return {{"count", asked.count}, {"seen", asked.seen}, {"answers", answers}};
}

}  // namespace

std::string to_json(const HardReport& report) {
  json peers = json::array();
  for (const Answerer& answerer : report.answerers) {
    if (answerer.is_peer()) peers.push_back({{"method", answerer.method}, {"version", answerer.version}});
  }
  json cases = json::array();
  for (const CaseResult& result : report.cases) {
    cases.push_back({{"name", result.hard_case->name},
                     {"group", result.hard_case->group},
                     {"built", result.hard_case->built},
                     {"definition", result.hard_case->definition},
                     {"instances", result.instances},
                     {"rays", answers_json(result.rays, report.answerers)},
                     {"pixels", answers_json(result.pixels, report.answerers)},
                     {"differences", result.differences}});
  }
  const json document = {{"plumb", PLUMB_VERSION},
                         {"seed", report.options.seed},
                         {"peers", peers},
                         {"cases", cases},
                         {"plumb_answers", report.plumb_total().asked},
                         {"agree", report.agrees()}};
  return document.dump(2);
}

}  // namespace plumb::tool
