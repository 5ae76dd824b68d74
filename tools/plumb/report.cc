#include "report.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <fmt/format.h>
#include <glm/vec3.hpp>
#include <nlohmann/json.hpp>

#include "plumb/ray.h"
#include "plumb/version.h"

namespace plumb::tool {
namespace {

using Json = nlohmann::ordered_json;

std::string milliseconds(std::optional<double> seconds) {
  return seconds ? fmt::format("{:.1f} ms", 1000.0 * *seconds) : "none";
}

template <typename Vector>
Json vector_json(const Vector& v) {
  return {v.x, v.y, v.z};
}

Json scene_json(const Scene& scene) {
  return {{"name", scene.name},
          {"vertices", scene.mesh.positions.size()},
          {"triangles", scene.mesh.triangles.size()}};
}

Json camera_json(const Camera& camera) {
  return {{"width", camera.width},          {"height", camera.height},
          {"eye", vector_json(camera.eye)}, {"corner", vector_json(camera.corner)},
          {"du", vector_json(camera.du)},   {"dv", vector_json(camera.dv)}};
}

Json run_json(const RunReport& report) {
  Json json = {{"name", report.run.name}, {"method", method_name(report.run.method)}};
  json["simd"] = report.run.simd ? Json(simd_name(*report.run.simd)) : Json();
  json["build_seconds"] = report.build_seconds ? Json(*report.build_seconds) : Json();
  json["frame_seconds"] = report.frame_seconds;
  json["seen_pixels"] = report.seen_pixels;
  json["files"] = report.files;
  if (report.choice)
    json["choice"] = {{"method", visible_method_name(report.choice->method)},
                      {"reason", report.choice->reason}};
  return json;
}

// JSON has no infinity: what sees nothing is null.
Json sight_json(float depth, std::uint32_t id) {
  return {{"t", std::isfinite(depth) ? Json(depth) : Json()}, {"id", id == kNone ? Json() : Json(id)}};
}

Json pair_json(const Pair& pair) {
  const Comparison& c = pair.comparison;
  Json first = Json::array();
  for (const PixelDifference& d : c.first) {
    first.push_back(
        {{"x", d.x}, {"y", d.y}, {"a", sight_json(d.depth_a, d.id_a)}, {"b", sight_json(d.depth_b, d.id_b)}});
  }
  return {{"a", pair.a},
          {"b", pair.b},
          {"layer", std::max(pair.layer, 1)},
          {"agree", c.equal()},
          {"pixels", c.pixels},
          {"different_pixels", c.different_pixels},
          {"different_ids", c.different_ids},
          {"different_depths", c.different_depths},
          {"first", first},
          {"picture", pair.picture ? Json(*pair.picture) : Json()}};
}

}  // namespace

std::string timing(const RunReport& report, std::size_t name_width) {
  const std::string choice =
      report.choice
          ? fmt::format("  took {}: {}", visible_method_name(report.choice->method), report.choice->reason)
          : "";
  return fmt::format("{:<{}}  build {:>10}  frame {:>10}{}", report.run.name, name_width,
                     milliseconds(report.build_seconds), milliseconds(report.frame_seconds), choice);
}

std::string verdict(const CompareReport& report) {
  const std::string& first = report.runs.front().run.name;
  if (report.pairs.empty()) return fmt::format("only {}: there is nothing to compare it with", first);
  const std::string layers = report.layers == 1 ? "" : fmt::format(" of {} layers", report.layers);
  const auto agreeing = std::count_if(report.pairs.begin(), report.pairs.end(),
                                      [](const Pair& pair) { return pair.comparison.equal(); });
  if (static_cast<std::size_t>(agreeing) == report.pairs.size()) {
    return fmt::format("all {} frames agree in every pixel{}", report.runs.size(), layers);
  }
  return fmt::format("{} of {} {} differ from {}", report.pairs.size() - static_cast<std::size_t>(agreeing),
                     report.pairs.size(), report.layers == 1 ? "frames" : "layers", first);
}

std::string to_json(const Scene& scene, int threads, const CompareReport& report) {
  Json runs = Json::array();
  for (const RunReport& run : report.runs) runs.push_back(run_json(run));
  Json pairs = Json::array();
  for (const Pair& pair : report.pairs) pairs.push_back(pair_json(pair));
  const Json json = {{"plumb", PLUMB_VERSION},
                     {"scene", scene_json(scene)},
                     {"camera", camera_json(scene.camera)},
                     {"threads", threads},
                     {"layers", report.layers},
                     {"runs", runs},
                     {"pairs", pairs},
                     {"agree", exit_status(report.pairs) == kAgree}};
  // A file's name may hold bytes that are no text.
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace plumb::tool
