#include <nlohmann/json.hpp>

#include <fmt/format.h>

#include "bench/task.h"
#include "plumb/version.h"
#include "report/speed_run.h"

namespace plumb::tool {
namespace {

using bench::Cell;
using bench::Work;
using nlohmann::json;

const Cell& cell(const SpeedRow& row, Work work) { return row.row.cells[static_cast<std::size_t>(work)]; }

std::string figure(const Cell& value) { return value.figure == 0 ? "" : fmt::format("{:.2f}", value.figure); }

// What is worst among the works: the table has one column each.
Errors worst(const SpeedRow& row) { return row.camera.asked != 0 ? row.camera : row.frame; }

json errors_json(const Errors& errors) {
  if (errors.asked == 0) return nullptr;
  return {{"asked", errors.asked},
          {"wrong_ids", errors.wrong_ids},
          {"wrong_per_million", errors.wrong_per_million()},
          {"lost", errors.lost},
          {"extra", errors.extra},
          {"seen_right", errors.seen_right},
          {"other_depths", errors.other_depths},
          {"worst_ulps", errors.worst_ulps},
          {"ulps_999", errors.ulps_999},
          {"mean_ulps", errors.mean_ulps}};
}

json rate_json(const Cell& value) { return value.figure == 0 ? json() : json(value.figure); }

}  // namespace

std::string speed_table(const SpeedReport& report) {
  std::string text =
      fmt::format("{}; {}; {}x{} pixels, {} thread{}, medians of {} rounds{}\n", report.machine,
                  report.compiler, report.options.width, report.options.height, report.options.threads,
                  report.options.threads == 1 ? "" : "s", report.options.rounds,
                  report.peer.empty() ? "" : "; beside it " + report.peer);
  for (const SpeedScene& scene : report.scenes) {
    text += fmt::format("\n{}: {} triangles, {} diffuse rays\n", scene.title, scene.triangles,
                        scene.diffuse_rays);
    text += fmt::format("  {:<18}{:<9}{:>9}{:>9}{:>9}{:>9}{:>13}{:>7}{:>7}{:>11}{:>8}{:>9}\n", "method",
                        "SIMD", "camera", "shadow", "diffuse", "frame", "wrong/10^6", "lost", "extra",
                        "max ulps", "99.9 %", "mean");
    for (const SpeedRow& row : scene.rows) {
      const Errors errors = worst(row);
      text += fmt::format("  {:<18}{:<9}{:>9}{:>9}{:>9}{:>9}{:>13.1f}{:>7}{:>7}{:>11}{:>8}{:>9.3f}\n",
                          row.row.method, row.row.target, figure(cell(row, Work::Camera)),
                          figure(cell(row, Work::Shadow)), figure(cell(row, Work::Diffuse)),
                          figure(cell(row, Work::Frame)), errors.wrong_per_million(), errors.lost,
                          errors.extra, errors.worst_ulps, errors.ulps_999, errors.mean_ulps);
    }
  }
  return text + "\nMrays/s, and ms for a frame; errors are those of camera rays, or of the frame.\n";
}

std::string speed_json(const SpeedReport& report) {
  json scenes = json::array();
  for (const SpeedScene& scene : report.scenes) {
    json rows = json::array();
    for (const SpeedRow& row : scene.rows) {
      rows.push_back({{"method", row.row.method},
                      {"simd", row.row.target.empty() ? json() : json(row.row.target)},
                      {"exact", row.row.exact},
                      {"camera_mrays", rate_json(cell(row, Work::Camera))},
                      {"shadow_mrays", rate_json(cell(row, Work::Shadow))},
                      {"diffuse_mrays", rate_json(cell(row, Work::Diffuse))},
                      {"frame_ms", rate_json(cell(row, Work::Frame))},
                      {"shadow_wrong", cell(row, Work::Shadow).wrong},
                      {"camera_errors", errors_json(row.camera)},
                      {"diffuse_errors", errors_json(row.diffuse)},
                      {"frame_errors", errors_json(row.frame)}});
    }
    scenes.push_back({{"name", scene.title},
                      {"triangles", scene.triangles},
                      {"diffuse_rays", scene.diffuse_rays},
                      {"rows", rows}});
  }
  return json{{"plumb", PLUMB_VERSION},
              {"machine", report.machine},
              {"compiler", report.compiler},
              {"peer", report.peer.empty() ? json() : json(report.peer)},
              {"width", report.options.width},
              {"height", report.options.height},
              {"threads", report.options.threads},
              {"rounds", report.options.rounds},
              {"scenes", scenes},
              {"agree", report.agrees()}}
      .dump(2);
}

}  // namespace plumb::tool
