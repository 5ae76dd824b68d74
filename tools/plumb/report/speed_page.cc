#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

#include "bench/task.h"
#include "report/plot.h"
#include "report/speed_run.h"

namespace plumb::tool {
namespace {

using bench::Work;

constexpr const char* kStyle =
    "body{font:16px/1.5 sans-serif;max-width:66rem;margin:2rem auto;padding:0 1rem;color:#222}"
    "table{border-collapse:collapse;font-size:14px;display:block;overflow-x:auto}"
    "td,th{padding:.2rem .6rem;text-align:right;border-bottom:1px solid #ddd;white-space:nowrap}"
    "td:first-child,th:first-child,td:nth-child(2),th:nth-child(2){text-align:left}"
    "tr.exact td:first-child{font-weight:bold}svg,img{max-width:100%;height:auto}"
    ".pictures{display:grid;grid-template-columns:repeat(auto-fill,minmax(18rem,1fr));gap:1rem}"
    "figure{margin:1rem 0}figcaption{font-size:14px;color:#555}";

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    result += c == '&'   ? "&amp;"
              : c == '<' ? "&lt;"
              : c == '>' ? "&gt;"
              : c == '"' ? "&quot;"
                         : std::string(1, c);
  }
  return result;
}

// RFC 4648.
std::string base64(const std::vector<std::byte>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return text;
}

std::string figure(const Image& image, const std::string& caption) {
  return fmt::format(
      "<figure><img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">"
      "<figcaption>{}</figcaption></figure>\n",
      image.width, image.height, escaped(caption), base64(encode_png(image)), escaped(caption));
}

int kind_of(const SpeedRow& row) {
  if (row.row.exact) return 0;
  return row.row.method.starts_with("embree") ? 2 : 1;
}

std::string name_of(const SpeedRow& row) {
  return row.row.target.empty() ? row.row.method : row.row.method + " " + row.row.target;
}

Plot plot_of(const SpeedScene& scene, Work work, const char* rays) {
  Plot plot{fmt::format("{}: {} rays", scene.title, rays),
            "Mrays/s",
            "wrong triangles per million rays",
            {},
            {"exact", "plumb, not exact", "Embree"}};
  for (const SpeedRow& row : scene.rows) {
    const double speed = row.row.cells[static_cast<std::size_t>(work)].figure;
    const Errors& errors = work == Work::Camera ? row.camera : row.diffuse;
    if (speed > 0.0 && std::isfinite(speed))
      plot.points.push_back({name_of(row), speed, errors.wrong_per_million(), kind_of(row)});
  }
  return plot;
}

std::string cell_text(const SpeedRow& row, Work work) {
  const double value = row.row.cells[static_cast<std::size_t>(work)].figure;
  return value == 0.0 ? "" : fmt::format("{:.2f}", value);
}

std::string table(const SpeedScene& scene) {
  std::string text =
      "<table><tr><th>method<th>SIMD<th>camera Mrays/s<th>shadow<th>diffuse<th>frame ms<th>wrong per million"
      "<th>lost<th>extra<th>diffuse wrong per million<th>depth ulps: max<th>99.9 %<th>mean</tr>\n";
  for (const SpeedRow& row : scene.rows) {
    const Errors& errors = row.camera.asked != 0 ? row.camera : row.frame;
    text += fmt::format(
        "<tr{}><td>{}<td>{}<td>{}<td>{}<td>{}<td>{}<td>{:.1f}<td>{}<td>{}<td>{}<td>{}<td>{}<td>{:.3f}</tr>\n",
        row.row.exact ? " class=\"exact\"" : "", escaped(row.row.method), row.row.target,
        cell_text(row, Work::Camera), cell_text(row, Work::Shadow), cell_text(row, Work::Diffuse),
        cell_text(row, Work::Frame), errors.wrong_per_million(), errors.lost, errors.extra,
        row.diffuse.asked == 0 ? "" : fmt::format("{:.1f}", row.diffuse.wrong_per_million()),
        errors.worst_ulps, errors.ulps_999, errors.mean_ulps);
  }
  return text + "</table>\n";
}

std::string section(const SpeedScene& scene) {
  std::string text =
      fmt::format("<section><h2>{}</h2>\n<p>{} triangles.</p>\n", escaped(scene.title), scene.triangles);
  text += figure(scene.depth, "What the camera sees: depth, near bright and far dark.");
  text += table(scene);
  text += "<figure>" + plot_svg(plot_of(scene, Work::Camera, "camera")) + "</figure>\n";
  text += "<figure>" + plot_svg(plot_of(scene, Work::Diffuse, "diffuse")) + "</figure>\n";
  text += "<div class=\"pictures\">\n";
  for (const ErrorPicture& picture : scene.pictures) {
    if (picture.different_pixels == 0) continue;
    text += figure(
        picture.image,
        fmt::format("{}: {} pixels differ, red where another triangle is seen, orange where only the depth "
                    "is another.",
                    picture.method, picture.different_pixels));
  }
  return text + "</div></section>\n";
}

}  // namespace

std::string speed_page(const SpeedReport& report) {
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width\"><title>plumb: speed against "
      "error</title><style>{}</style></head><body>\n"
      "<h1>Speed against error</h1>\n"
      "<p>{}; {}; {}&times;{} pixels; {} thread(s); medians of {} rounds, all methods in turns on the same "
      "rays{}. "
      "Right and low is better; &ldquo;none&rdquo; is no wrong answer at all. Bold: exact, every bit.</p>\n",
      kStyle, escaped(report.machine), escaped(report.compiler), report.options.width, report.options.height,
      report.options.threads, report.options.rounds,
      report.peer.empty() ? "" : ", beside " + escaped(report.peer));
  for (const SpeedScene& scene : report.scenes) text += section(scene);
  return text + "</body></html>\n";
}

}  // namespace plumb::tool
