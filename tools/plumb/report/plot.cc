#include "report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "plumb/error.h"

namespace plumb::tool {
namespace {

namespace fs = std::filesystem;

// What gnuplot reads in double quotes.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    if (c != '\n') result += c;
  }
  return result + "\"";
}

// A folder for a script and a picture, removed at the end.
class Scratch {
 public:
  Scratch() {
    std::string pattern = (fs::temp_directory_path() / "plumb-plot-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw Error("plumb: " + pattern + ": no folder for a plot can be made");
    path_ = pattern;
  }
  ~Scratch() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

// Where errors of 0 are drawn: a factor below the least that is above 0.
double floor_of(const std::vector<PlotPoint>& points) {
  double least = 1e3;
  for (const PlotPoint& point : points) {
    if (point.y > 0.0) least = std::min(least, point.y);
  }
  return std::pow(10.0, std::floor(std::log10(least))) / 10.0;
}

std::string script_of(const Plot& plot, const fs::path& picture) {
  const double floor = floor_of(plot.points);
  const bool has_zero =
      std::any_of(plot.points.begin(), plot.points.end(), [](const PlotPoint& p) { return !(p.y > 0.0); });
  double least_x = plot.points.empty() ? 1.0 : plot.points.front().x, greatest_x = least_x;
  for (const PlotPoint& point : plot.points) {
    least_x = std::min(least_x, point.x);
    greatest_x = std::max(greatest_x, point.x);
  }
  std::string script = fmt::format(
      "set terminal svg size 860,520 dynamic font 'sans-serif,13' background '#ffffff'\nset output '{}'\n"
      "set title {} noenhanced\nset xlabel {}\nset ylabel {}\nset logscale xy\nset grid lc rgb '#dddddd'\n"
      "set key outside below horizontal noenhanced\nset xrange [{}:{}]\nset format xy '10^{{%L}}'\n",
      picture.string(), quoted(plot.title), quoted(plot.x_label), quoted(plot.y_label), least_x / 1.5,
      greatest_x * (plot.lines ? 1.5 : 2.2));
  if (!plot.lines) script += "set format x '%g'\n";
  if (has_zero) script += fmt::format("set yrange [{}:]\nset ytics add ('none' {})\n", floor / 2.0, floor);
  for (std::size_t kind = 0; kind < plot.kinds.size(); ++kind) {
    script += fmt::format("$kind{} << EOD\n", kind);
    for (const PlotPoint& point : plot.points) {
      if (point.kind != static_cast<int>(kind)) continue;
      script += fmt::format("{} {} {}\n", point.x, point.y > 0.0 ? point.y : floor, quoted(point.name));
    }
    script += "EOD\n";
  }
  constexpr std::array<const char*, 8> kColours = {"#1b7837", "#d95f02", "#7570b3", "#666666",
                                                   "#1f78b4", "#e7298a", "#a6761d", "#000000"};
  std::string separator = "plot ";
  for (std::size_t kind = 0; kind < plot.kinds.size(); ++kind) {
    const bool any = std::any_of(plot.points.begin(), plot.points.end(), [&](const PlotPoint& point) {
      return point.kind == static_cast<int>(kind);
    });
    if (!any) continue;
    const char* const colour = kColours[kind % kColours.size()];
    if (plot.lines) {
      script += fmt::format("{}$kind{} using 1:2 with linespoints pt {} ps 0.7 lw 1.6 lc rgb '{}' title {}",
                            separator, kind, 4 + kind, colour, quoted(plot.kinds[kind]));
      separator = ", ";
      continue;
    }
    script += fmt::format(
        "{}$kind{} using 1:2 with points pt {} ps 0.9 lc rgb '{}' title {}, $kind{} using 1:2:3 with labels "
        "noenhanced left rotate by 25 offset 0.8,0.5 font ',11' tc rgb '{}' notitle",
        separator, kind, 5 + 2 * kind, colour, quoted(plot.kinds[kind]), kind, colour);
    separator = ", ";
  }
  return script + "\n";
}

}  // namespace

std::string plot_svg(const Plot& plot) {
  if (plot.points.empty()) return "";
  const Scratch scratch;
  const fs::path script = scratch / "plot.gp", picture = scratch / "plot.svg", log = scratch / "log";
  std::ofstream(script) << script_of(plot, picture);
  const std::string command = fmt::format("gnuplot '{}' > '{}' 2>&1", script.string(), log.string());
  const int status = std::system(command.c_str());
  std::ifstream in(picture);
  std::ostringstream text;
  text << in.rdbuf();
  const std::size_t begin = text.str().find("<svg");
  if (status != 0 || begin == std::string::npos) {
    std::ifstream said(log);
    std::string line;
    while (line.empty() && std::getline(said, line)) {
    }
    throw Error(
        fmt::format("plumb: --html draws its plots with gnuplot, which failed ({}); install it (Debian: "
                    "gnuplot-nox)",
                    line));
  }
  return text.str().substr(begin);
}

}  // namespace plumb::tool
