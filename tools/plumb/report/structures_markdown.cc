#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "report/plot.h"
#include "report/structures_run.h"

namespace plumb::tool {
namespace {

using Figure = std::function<double(const StructureRow&)>;

// 1234567 as "1,234,567".
std::string grouped(std::size_t number) {
  return number < 1000 ? std::to_string(number)
                       : fmt::format("{},{:03}", grouped(number / 1000), number % 1000);
}

std::string three_digits(double value) {
  if (!std::isfinite(value)) return "";
  return value >= 99.95 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

double milliseconds(const StructureRow& row) { return 1e3 * row.build_seconds; }

// Seconds for a build and so many rays, half of them from a camera and half diffuse.
double total_seconds(const StructureRow& row, double rays) {
  const double diffuse = row.diffuse.mrays > 0.0 ? row.diffuse.mrays : row.camera.mrays;
  return row.build_seconds + 0.5e-6 * rays * (1.0 / row.camera.mrays + 1.0 / diffuse);
}

const StructureRow& best(const StructureScene& scene, const Figure& cost) {
  return *std::min_element(scene.rows.begin(), scene.rows.end(),
                           [&](const StructureRow& a, const StructureRow& b) { return cost(a) < cost(b); });
}

class Document {
 public:
  Document(const StructuresReport& report, const std::vector<NamedPlot>& plots, const std::string& stem)
      : report_(report), plots_(plots), stem_(stem) {}

  std::string text() {
    introduction();
    line("\n## Scenes");
    for (const StructureScene& scene : report_.scenes) scene_table(scene);
    for (const StructureSeries& series : report_.series) series_tables(series);
    choices();
    advice();
    return std::move(text_);
  }

 private:
  template <typename... Arguments>
  void line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
    text_ += '\n';
  }

  void introduction() {
    const StructuresOptions& options = report_.options;
    line("# Structures, and when to use which\n");
    line("Made by `plumb report --structures`; not to be edited by hand.\n");
    line(
        "Every structure answers what [visibility.md](visibility.md) defines: before anything was timed, all "
        "answers "
        "were compared with the binary BVH's, bit for bit{}.\n",
        report_.agrees() ? ", and none differed" : ", AND SOME DIFFERED (see \"wrong\")");
    line("| name | what it is |\n|---|---|");
    line("| bvh2 | binary tree of boxes, by the surface area heuristic over 32 bins; plain scalar code |");
    line(
        "| bvh8 | the same collapsed to 8 children a node, boxes and triangles tested by SIMD; what `Bvh` is "
        "unless told otherwise |");
    line("| bvh8-fast | bvh8 of `Quality::Fast` |");
    line("| brute | every ray against every triangle by SIMD; only where there are few |");
    line("| spheres | bvh2 with a bounding sphere for each box |");
    line("| kdtree | k-d tree by the surface area heuristic, triangles clipped to their cells |");
    line("| grid | uniform grid of about as many cells as triangles |");
    line("| octree | adaptive octree |");
    line(
        "\n{}; {}; {} thread{}; {}x{} pixels; medians of {} rounds, in which all took turns. Camera rays are "
        "the "
        "pixels', shadow rays (any hit) go from what is seen to a light near the eye, diffuse rays start "
        "there and "
        "follow the cosine law. Volumes (boxes, spheres or cells; each child of a wide node for itself) and "
        "triangles "
        "are those tested for a ray, on average.",
        report_.machine, report_.compiler, options.threads, options.threads == 1 ? "" : "s", options.width,
        options.height, options.rounds);
  }

  void scene_table(const StructureScene& scene) {
    line("\n### {}\n\n{} triangles.\n", scene.title, grouped(scene.triangles));
    line(
        "| | build ms | bytes/triangle | references/triangle | camera Mrays/s | shadow | diffuse | camera: "
        "volumes | "
        "triangles | diffuse: volumes | triangles |{}",
        report_.agrees() ? "" : " wrong |");
    line("|---|---|---|---|---|---|---|---|---|---|---|{}", report_.agrees() ? "" : "---|");
    for (const StructureRow& row : scene.rows) {
      const auto finite = static_cast<double>(
          std::max<std::size_t>(1, row.statistics.triangles - row.statistics.unseen_triangles));
      line("| {} | {} | {} | {} | {} | {} | {} | {} | {} | {} | {} |{}", row.name,
           three_digits(milliseconds(row)), three_digits(row.bytes_per_triangle()),
           three_digits(static_cast<double>(row.statistics.references) / finite),
           three_digits(row.camera.mrays), three_digits(row.shadow.mrays), three_digits(row.diffuse.mrays),
           three_digits(row.camera.volumes), three_digits(row.camera.triangles),
           three_digits(row.diffuse.volumes), three_digits(row.diffuse.triangles),
           report_.agrees() ? "" : fmt::format(" {} |", row.wrong));
    }
  }

  void series_table(const StructureSeries& series, const std::string& what, bool with_exponent,
                    const Figure& figure) {
    std::string head = fmt::format("| {} |", what), rule = "|---|";
    for (const double x : series.x) {
      head += fmt::format(" {} |", grouped(static_cast<std::size_t>(x)));
      rule += "---|";
    }
    line("\n{}{}\n{}{}", head, with_exponent ? " exponent |" : "", rule, with_exponent ? "---|" : "");
    for (const std::string& name : row_names(series.scenes)) {
      const std::vector<double> values = figures(series, name, figure);
      std::string cells;
      for (const double value : values) cells += fmt::format(" {} |", value > 0.0 ? three_digits(value) : "");
      if (with_exponent) {
        // Where n is small, caches and fixed costs rule.
        std::vector<double> x, y;
        for (std::size_t i = 0; i < values.size(); ++i) {
          if (series.x[i] < 900.0) continue;
          x.push_back(series.x[i]);
          y.push_back(values[i]);
        }
        const double exponent = fitted_exponent(x, y);
        cells += fmt::format(" {} |", std::isfinite(exponent) ? fmt::format("{:.2f}", exponent) : "");
      }
      line("| {} |{}", name, cells);
    }
  }

  void series_tables(const StructureSeries& series) {
    line("\n## Growing: {}\n\nBy {}.", series.title, series.x_label);
    const bool by_size = series.x_label == "triangles";
    if (by_size) line("The exponent is that of a power of n fitted to the points from a thousand on.");
    series_table(series, "build ms", by_size, milliseconds);
    series_table(series, "camera, microseconds a ray", by_size,
                 [](const StructureRow& row) { return 1.0 / row.camera.mrays; });
    series_table(series, "diffuse, microseconds a ray", by_size, [](const StructureRow& row) {
      return row.diffuse.mrays > 0.0 ? 1.0 / row.diffuse.mrays : 0.0;
    });
    for (const NamedPlot& plot : plots_) {
      if (plot.title.find(series.title) == std::string::npos) continue;
      line("\n![{}]({}-{}.svg)", plot.title, stem_, plot.name);
    }
  }

  void choice(const StructureScene& scene, const std::string& purpose, const std::string& unit,
              const Figure& cost) {
    const StructureRow& first = best(scene, cost);
    std::string others;
    for (const StructureRow& row : scene.rows) {
      if (row.name == first.name) continue;
      others += fmt::format("{}{} {}", others.empty() ? "" : ", ", row.name, three_digits(cost(row)));
    }
    line("| {} | {} | **{}** | {} {} | {} |", scene.title, purpose, first.name, three_digits(cost(first)),
         unit, others);
  }

  void choices() {
    line("\n## When to use which\n\nThe best of each measured row above, and what the others take.\n");
    line("| scene | what for | take | takes | the others |\n|---|---|---|---|---|");
    const auto lines_of = [&](const StructureScene& scene) {
      const auto frame = static_cast<double>(scene.camera_rays);
      choice(scene, "many rays from a camera", "us a ray",
             [](const StructureRow& row) { return 1.0 / row.camera.mrays; });
      choice(scene, "many incoherent rays", "us a ray", [](const StructureRow& row) {
        return 1.0 / (row.diffuse.mrays > 0.0 ? row.diffuse.mrays : row.camera.mrays);
      });
      choice(scene, fmt::format("a scene that moves: a build and {} rays", grouped(scene.camera_rays)), "ms",
             [frame](const StructureRow& row) { return 1e3 * total_seconds(row, frame); });
      choice(scene, "least memory", "bytes a triangle",
             [](const StructureRow& row) { return row.bytes_per_triangle(); });
    };
    for (const StructureScene& scene : report_.scenes) lines_of(scene);
    for (const StructureSeries& series : report_.series) {
      if (series.x_label == "triangles") {
        lines_of(series.scenes.front());
        lines_of(series.scenes.back());
      } else {
        for (const StructureScene& scene : series.scenes) lines_of(scene);
      }
    }
  }

  template <typename Visit>
  void for_each_scene(const Visit& visit) const {
    for (const StructureScene& scene : report_.scenes) visit(scene);
    for (const StructureSeries& series : report_.series) {
      for (const StructureScene& scene : series.scenes) visit(scene);
    }
  }

  void advice() {
    line(
        "\n## What advise() says\n\nFor a build and so many rays, half of them from the camera and half "
        "diffuse: what it "
        "advises, how long that takes as measured above, and the best.\n");
    line("| scene | rays | advised | takes, s | best | takes, s | ratio |\n|---|---|---|---|---|---|---|");
    int right = 0, all = 0;
    double worst = 1.0, log_sum = 0.0;
    for_each_scene([&](const StructureScene& scene) {
      for (const StructureAdvice& advised : scene.advice) {
        const auto cost = [&](const StructureRow& row) { return total_seconds(row, advised.rays); };
        const auto row = std::find_if(scene.rows.begin(), scene.rows.end(),
                                      [&](const StructureRow& r) { return r.name == advised.name; });
        if (row == scene.rows.end()) continue;
        const StructureRow& first = best(scene, cost);
        const double ratio = cost(*row) / cost(first);
        line("| {} | {} | {} | {} | {} | {} | {:.2f} |", scene.title,
             grouped(static_cast<std::size_t>(advised.rays)), advised.name, three_digits(cost(*row)),
             first.name, three_digits(cost(first)), ratio);
        ++all;
        right += ratio <= 1.1 ? 1 : 0;
        worst = std::max(worst, ratio);
        log_sum += std::log(ratio);
      }
    });
    if (all == 0) return;
    line(
        "\nRight, within a tenth, in {} of {}; it costs {:.2f} times the best on (geometric) average, at "
        "worst {:.2f} "
        "times.",
        right, all, std::exp(log_sum / all), worst);
  }

  const StructuresReport& report_;
  const std::vector<NamedPlot>& plots_;
  const std::string& stem_;
  std::string text_;
};

NamedPlot series_plot(const StructureSeries& series, const std::string& name, const std::string& what,
                      const Figure& figure) {
  Plot plot;
  plot.lines = true;
  plot.title = fmt::format("{}: {}", series.title, what);
  plot.x_label = series.x_label;
  plot.y_label = what;
  for (const std::string& row : row_names(series.scenes)) {
    const std::vector<double> values = figures(series, row, figure);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (values[i] > 0.0)
        plot.points.push_back({row, series.x[i], values[i], static_cast<int>(plot.kinds.size())});
    }
    plot.kinds.push_back(row);
  }
  return {name, plot.title, plot_svg(plot)};
}

}  // namespace

std::vector<NamedPlot> structures_plots(const StructuresReport& report) {
  std::vector<NamedPlot> plots;
  int number = 0;
  for (const StructureSeries& series : report.series) {
    const std::string name = fmt::format("{}", ++number);
    plots.push_back(series_plot(series, "build-" + name, "build, ms", milliseconds));
    plots.push_back(series_plot(series, "camera-" + name, "camera rays, microseconds a ray",
                                [](const StructureRow& row) { return 1.0 / row.camera.mrays; }));
  }
  return plots;
}

std::string structures_markdown(const StructuresReport& report, const std::vector<NamedPlot>& plots,
                                const std::string& stem) {
  return Document(report, plots, stem).text();
}

}  // namespace plumb::tool
