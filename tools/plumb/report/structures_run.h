#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "plumb/structures.h"

// Every structure on scenes that favour one or another: what it takes to build, to hold and to ask.

namespace plumb::tool {

struct StructuresOptions {
  std::vector<std::string> scenes;  ///< builtin:NAME[:SIZE], or files; beside them series of growing ones
  int width = 320, height = 180;
  int rounds = 3;
  int threads = 1;
  std::size_t greatest = 1'000'000;  ///< triangles of the largest of a series, at least 100
};

/// What a kind of rays takes.
struct RayFigures {
  double mrays = 0;      ///< million a second
  double volumes = 0;    ///< boxes, spheres or cells tested, a ray; 0 where it was not counted
  double triangles = 0;  ///< tested, a ray
};

struct StructureRow {
  std::string name;
  Statistics statistics;
  double build_seconds = 0;
  RayFigures camera, shadow, diffuse;
  std::uint64_t wrong = 0;  ///< answers that are not the reference's

  double bytes_per_triangle() const;
};

/// What advise() says for so many rays.
struct StructureAdvice {
  double rays;
  std::string name;  ///< of the row
};

struct StructureScene {
  std::string title;
  std::size_t triangles = 0;
  std::size_t camera_rays = 0;
  std::vector<StructureRow> rows;  ///< brute force only where there are few triangles
  std::vector<StructureAdvice> advice;
};

/// Scenes of one kind that grow in something.
struct StructureSeries {
  std::string title, x_label;
  std::vector<double> x;
  std::vector<StructureScene> scenes;  ///< one each
};

struct StructuresReport {
  StructuresOptions options;
  std::string machine, compiler;
  std::vector<StructureScene> scenes;
  std::vector<StructureSeries> series;

  /// Whether every answer was the reference's.
  bool agrees() const;
};

/// `progress` is called with what is measured.
StructuresReport measure_structures(const StructuresOptions& options,
                                    const std::function<void(const std::string&)>& progress);

/// The exponent b of the least squares fit y = a x^b, over the points with y > 0; NaN for fewer than two.
double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y);

/// A figure of the row called `name`, for each scene; 0 where there is none.
std::vector<double> figures(const StructureSeries& series, const std::string& name,
                            const std::function<double(const StructureRow&)>& figure);

/// Names in the order in which they first come.
std::vector<std::string> row_names(const std::vector<StructureScene>& scenes);

/// A picture of the report, and the end of its file's name.
struct NamedPlot {
  std::string name, title, svg;
};
/// They need the program gnuplot; without it plumb::Error.
std::vector<NamedPlot> structures_plots(const StructuresReport& report);

/// The report as a document, which shows the plots as the files `stem`-NAME.svg, and as JSON (docs/tool.md).
std::string structures_markdown(const StructuresReport& report, const std::vector<NamedPlot>& plots,
                                const std::string& stem);
std::string structures_json(const StructuresReport& report);

}  // namespace plumb::tool
