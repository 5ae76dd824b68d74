#include "report/structures_run.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "bench/chunks.h"
#include "bench/machine.h"
#include "bench/rays.h"
#include "bench/scene.h"
#include "bench/timing.h"
#include "plumb/advise.h"

namespace plumb::tool {
namespace {

using bench::RaySet;
using bench::Workload;

// Every ray against every triangle takes too long for more.
constexpr std::size_t kBruteForceLimit = 4'000;

struct Entrant {
  std::string name;
  StructureSettings settings;
};

std::vector<Entrant> entrants(int threads, std::size_t triangles) {
  std::vector<Entrant> list;
  for (const StructureKind kind : structure_kinds()) {
    if (kind == StructureKind::BruteForce && triangles > kBruteForceLimit) continue;
    StructureSettings settings;
    settings.kind = kind;
    settings.threads = threads;
    if (kind != StructureKind::Bvh) {
      list.push_back({std::string(structure_kind_name(kind)), settings});
      continue;
    }
    for (const int width : {2, 8}) {
      settings.width = width;
      list.push_back({fmt::format("bvh{}", width), settings});
    }
    settings.quality = Quality::Fast;
    list.push_back({"bvh8-fast", settings});
  }
  return list;
}

void ask(const Structure& structure, RaySet<Hit>& set, int threads) {
  bench::in_chunks(set.rays.size(), threads, [&](std::size_t first, std::size_t count) {
    structure.closest(std::span<const Ray>(set.rays).subspan(first, count),
                      set.answer_span().subspan(first, count));
  });
}

void ask(const Structure& structure, RaySet<bool>& set, int threads) {
  bench::in_chunks(set.rays.size(), threads, [&](std::size_t first, std::size_t count) {
    structure.any(std::span<const Ray>(set.rays).subspan(first, count),
                  set.answer_span().subspan(first, count));
  });
}

template <typename Set>
std::uint64_t wrong_answers(const Structure& structure, Set& set, int threads) {
  bench::spoil(set);
  ask(structure, set, threads);
  return bench::differences(set);
}

RayFigures count_tests(const Structure& structure, const std::vector<Ray>& rays) {
  if (rays.empty()) return {};
  const TestCounts counts = structure.count_tests(rays);
  const auto each = 1.0 / static_cast<double>(rays.size());
  return {0.0, static_cast<double>(counts.volumes) * each, static_cast<double>(counts.triangles) * each};
}

// The speeds of all structures on one set of rays, in turns.
template <typename Set>
void time_rays(const std::vector<Structure>& structures, Set& set, const StructuresOptions& options,
               RayFigures StructureRow::*figures, std::vector<StructureRow>& rows) {
  std::vector<std::function<void()>> works;
  for (const Structure& structure : structures)
    works.emplace_back([&] { ask(structure, set, options.threads); });
  const std::vector<double> seconds = bench::time_interleaved(works, options.rounds, options.threads);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (seconds[i] > 0.0) (rows[i].*figures).mrays = 1e-6 * static_cast<double>(set.rays.size()) / seconds[i];
  }
}

// For a frame, for many, and for a day's.
std::vector<StructureAdvice> advice_for(MeshView mesh) {
  std::vector<StructureAdvice> list;
  for (const double rays : {1e5, 1e7, 1e9}) {
    const StructureSettings settings = advise(mesh, rays).settings;
    std::string name(structure_kind_name(settings.kind));
    if (settings.kind == StructureKind::Bvh) name = settings.quality == Quality::Fast ? "bvh8-fast" : "bvh8";
    list.push_back({rays, name});
  }
  return list;
}

StructureScene measure(std::string title, bench::View view, const StructuresOptions& options) {
  const std::unique_ptr<Workload> workload = bench::make_workload(std::move(view));
  const TriangleMesh& mesh = workload->view.mesh;
  StructureScene scene{
      std::move(title), mesh.triangles.size(), workload->camera.rays.size(), {}, advice_for(mesh)};
  std::vector<Structure> structures;
  std::vector<std::function<void()>> builds;
  for (const Entrant& entrant : entrants(options.threads, mesh.triangles.size())) {
    const Structure structure = build_structure(mesh, entrant.settings);
    StructureRow row{entrant.name, structure.statistics(), 0.0, {}, {}, {}, 0};
    row.wrong = wrong_answers(structure, workload->camera, options.threads) +
                wrong_answers(structure, workload->shadow, options.threads) +
                wrong_answers(structure, workload->diffuse, options.threads);
    row.camera = count_tests(structure, workload->camera.rays);
    row.diffuse = count_tests(structure, workload->diffuse.rays);
    scene.rows.push_back(row);
    structures.push_back(structure);
    builds.emplace_back([&mesh, settings = entrant.settings] { build_structure(mesh, settings); });
  }
  // What takes seconds is timed well enough once.
  const int rounds = mesh.triangles.size() > 3'000'000 ? 1 : options.rounds;
  const std::vector<double> seconds = bench::time_interleaved(builds, rounds, options.threads);
  for (std::size_t i = 0; i < scene.rows.size(); ++i) scene.rows[i].build_seconds = seconds[i];
  time_rays(structures, workload->camera, options, &StructureRow::camera, scene.rows);
  time_rays(structures, workload->shadow, options, &StructureRow::shadow, scene.rows);
  time_rays(structures, workload->diffuse, options, &StructureRow::diffuse, scene.rows);
  return scene;
}

StructureScene measure(const std::string& scene, const StructuresOptions& options) {
  const bench::ViewName name{scene, "", ""};
  return measure(name.title(), bench::load_view(name, options.width, options.height), options);
}

// A hundred, a thousand and so on up to the greatest.
StructureSeries growing(const std::string& name, const StructuresOptions& options,
                        const std::function<void(const std::string&)>& progress) {
  StructureSeries series{name, "triangles", {}, {}};
  for (std::size_t size = 100; size <= options.greatest; size *= 10) {
    const std::string scene = fmt::format("builtin:{}:{}", name, size);
    progress(scene);
    series.scenes.push_back(measure(scene, options));
    series.x.push_back(static_cast<double>(series.scenes.back().triangles));
  }
  return series;
}

// The teapot of the built-in stadium, in which the stadium is `ratio` times its size: all else is scaled
// about the teapot. The teapot is what lies within a quarter of a metre of it.
bench::View teapot_in_stadium(double ratio, const StructuresOptions& options) {
  bench::View view =
      bench::load_view({"builtin:teapot-in-stadium:60000", "", ""}, options.width, options.height);
  const auto scale = static_cast<float>(ratio / 1000.0);
  const glm::vec3 middle(0.0f, 1.1f, 0.0f);
  for (glm::vec3& p : view.mesh.positions) {
    const bool of_teapot = std::fabs(p.x) < 0.25f && std::fabs(p.z) < 0.25f && p.y > 1.1f;
    if (!of_teapot) p = middle + (p - middle) * scale;
  }
  return view;
}

StructureSeries stadium(const StructuresOptions& options,
                        const std::function<void(const std::string&)>& progress) {
  StructureSeries series{"teapot in a stadium", "stadium to teapot, in length", {}, {}};
  for (const double ratio : {10.0, 100.0, 1000.0, 10'000.0, 100'000.0}) {
    const std::string title = fmt::format("a stadium {} teapots long", ratio);
    progress(title);
    series.x.push_back(ratio);
    series.scenes.push_back(measure(title, teapot_in_stadium(ratio, options), options));
  }
  return series;
}

}  // namespace

double StructureRow::bytes_per_triangle() const {
  return statistics.triangles == 0
             ? 0.0
             : static_cast<double>(statistics.bytes) / static_cast<double>(statistics.triangles);
}

bool StructuresReport::agrees() const {
  const auto all_right = [](const StructureScene& scene) {
    return std::all_of(scene.rows.begin(), scene.rows.end(),
                       [](const StructureRow& row) { return row.wrong == 0; });
  };
  return std::all_of(scenes.begin(), scenes.end(), all_right) &&
         std::all_of(series.begin(), series.end(), [&](const StructureSeries& s) {
           return std::all_of(s.scenes.begin(), s.scenes.end(), all_right);
         });
}

StructuresReport measure_structures(const StructuresOptions& options,
                                    const std::function<void(const std::string&)>& progress) {
  StructuresReport report{options, bench::machine_name(), bench::compiler_name(), {}, {}};
  for (const std::string& scene : options.scenes) {
    progress(scene);
    report.scenes.push_back(measure(scene, options));
  }
  for (const char* name : {"soup", "terrain"}) report.series.push_back(growing(name, options, progress));
  report.series.push_back(stadium(options, progress));
  return report;
}

double fitted_exponent(const std::vector<double>& x, const std::vector<double>& y) {
  double n = 0.0, sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) {
    if (!(x[i] > 0.0) || !(y[i] > 0.0)) continue;
    const double log_x = std::log(x[i]), log_y = std::log(y[i]);
    n += 1.0;
    sum_x += log_x;
    sum_y += log_y;
    sum_xx += log_x * log_x;
    sum_xy += log_x * log_y;
  }
  const double spread = n * sum_xx - sum_x * sum_x;
  if (n < 2.0 || !(spread > 0.0)) return std::numeric_limits<double>::quiet_NaN();
  return (n * sum_xy - sum_x * sum_y) / spread;
}

std::vector<double> figures(const StructureSeries& series, const std::string& name,
                            const std::function<double(const StructureRow&)>& figure) {
  std::vector<double> values;
  for (const StructureScene& scene : series.scenes) {
    const auto row = std::find_if(scene.rows.begin(), scene.rows.end(),
                                  [&](const StructureRow& candidate) { return candidate.name == name; });
    values.push_back(row == scene.rows.end() ? 0.0 : figure(*row));
  }
  return values;
}

std::vector<std::string> row_names(const std::vector<StructureScene>& scenes) {
  std::vector<std::string> names;
  for (const StructureScene& scene : scenes) {
    for (const StructureRow& row : scene.rows) {
      if (std::find(names.begin(), names.end(), row.name) == names.end()) names.push_back(row.name);
    }
  }
  return names;
}

}  // namespace plumb::tool
