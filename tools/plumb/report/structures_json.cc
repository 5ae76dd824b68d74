#include <cmath>

#include <nlohmann/json.hpp>

#include "plumb/version.h"
#include "report/structures_run.h"

namespace plumb::tool {
namespace {

using nlohmann::json;

json rays_json(const RayFigures& figures) {
  return {
      {"mrays_per_second", figures.mrays}, {"volumes", figures.volumes}, {"triangles", figures.triangles}};
}

json scene_json(const StructureScene& scene) {
  json rows = json::array();
  for (const StructureRow& row : scene.rows) {
    rows.push_back({{"structure", row.name},
                    {"build_seconds", row.build_seconds},
                    {"bytes", row.statistics.bytes},
                    {"references", row.statistics.references},
                    {"nodes", row.statistics.nodes},
                    {"leaves", row.statistics.leaves},
                    {"depth", row.statistics.depth},
                    {"wrong", row.wrong},
                    {"camera", rays_json(row.camera)},
                    {"shadow", {{"mrays_per_second", row.shadow.mrays}}},
                    {"diffuse", rays_json(row.diffuse)}});
  }
  return {{"title", scene.title}, {"triangles", scene.triangles}, {"structures", rows}};
}

}  // namespace

std::string structures_json(const StructuresReport& report) {
  json scenes = json::array(), series = json::array();
  for (const StructureScene& scene : report.scenes) scenes.push_back(scene_json(scene));
  for (const StructureSeries& s : report.series) {
    json of_series = json::array();
    for (const StructureScene& scene : s.scenes) of_series.push_back(scene_json(scene));
    series.push_back({{"title", s.title}, {"x_label", s.x_label}, {"x", s.x}, {"scenes", of_series}});
  }
  const json document = {{"plumb", PLUMB_VERSION},
                         {"machine", report.machine},
                         {"compiler", report.compiler},
                         {"threads", report.options.threads},
                         {"rounds", report.options.rounds},
                         {"scenes", scenes},
                         {"series", series},
                         {"agree", report.agrees()}};
  return document.dump(2);
}

}  // namespace plumb::tool
