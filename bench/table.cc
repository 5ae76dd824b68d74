#include "table.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "embree_peer.h"
#include "plumb/error.h"
#include "timing.h"

namespace plumb::bench {
namespace {

bool is_rate(Work work) { return work != Work::Frame && work != Work::Build; }

Row& row_of(std::vector<Row>& rows, const Task& task) {
  for (Row& row : rows) {
    if (row.method == task.method && row.target == task.target) return row;
  }
  rows.push_back({task.method, task.target, task.exact, {}, 0});
  return rows.back();
}

Cell& cell_of(Row& row, Work work) { return row.cells[static_cast<std::size_t>(work)]; }

void check(const Task& task, const std::function<void(const Task&)>& after_check, std::vector<Row>& rows) {
  const std::size_t wrong = task.check();
  if (after_check) {
    after_check(task);
  } else if (task.exact && wrong != 0) {
    throw Error("plumb_bench: " + task.method + " " + task.target + ", " + work_name(task.work) + ": " +
                std::to_string(wrong) + " answers differ from the binary BVH's");
  }
  cell_of(row_of(rows, task), task.work).wrong = wrong;
}

// Exact methods and the others in turns: exact, other, exact, ...
std::vector<const Task*> in_turns(const std::vector<Task>& tasks, Work work) {
  std::vector<const Task*> exact, others, turns;
  for (const Task& task : tasks) {
    if (task.work == work) (task.exact ? exact : others).push_back(&task);
  }
  for (std::size_t i = 0; i < std::max(exact.size(), others.size()); ++i) {
    if (i < exact.size()) turns.push_back(exact[i]);
    if (i < others.size()) turns.push_back(others[i]);
  }
  return turns;
}

void time_work(const std::vector<Task>& tasks, Work work, int rounds, int threads, std::vector<Row>& rows) {
  const std::vector<const Task*> turns = in_turns(tasks, work);
  std::vector<std::size_t> done(turns.size());
  std::vector<std::function<void()>> runs;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    runs.emplace_back([&done, &turns, i] { done[i] = turns[i]->run(); });
  }
  const std::vector<double> seconds = time_interleaved(runs, rounds, threads);
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const double rate = static_cast<double>(done[i]) / seconds[i] * 1e-6;
    cell_of(row_of(rows, *turns[i]), work).figure = is_rate(work) ? rate : seconds[i] * 1e3;
  }
}

// Of rows whose method `counts`, the fastest at each work; 0 where none does it.
template <typename Counts>
std::array<double, kWorkCount> fastest(const std::vector<Row>& rows, const Counts& counts) {
  std::array<double, kWorkCount> best{};
  for (const Row& row : rows) {
    if (!counts(row.method)) continue;
    for (const Work work : kWorks) {
      const auto w = static_cast<std::size_t>(work);
      const double figure = row.cells[w].figure;
      if (figure != 0 && (best[w] == 0 || (is_rate(work) ? figure > best[w] : figure < best[w])))
        best[w] = figure;
    }
  }
  return best;
}

bool begins_with(const std::string& text, const char* with) { return text.rfind(with, 0) == 0; }
bool ends_with(const std::string& text, const std::string& with) {
  return text.size() >= with.size() && text.compare(text.size() - with.size(), with.size(), with) == 0;
}

// What a method is compared with. Against the best, calls for one ray have the peer's of their kind, and
// builds the one of their quality.
std::array<double, kWorkCount> baseline_of(const std::string& method, Baseline baseline,
                                           const std::vector<Row>& rows) {
  if (baseline == Baseline::SingleRays)
    return fastest(rows, [](const std::string& m) { return m == kEmbreeBaseline; });
  const bool single = ends_with(method, "-single");
  std::array<double, kWorkCount> best = fastest(rows, [&](const std::string& m) {
    return begins_with(m, "embree-fast") && (!single || ends_with(m, "-1"));
  });
  const char* const quality = ends_with(method, "-fast-build")   ? "embree-fast-low-1"
                              : ends_with(method, "-best-build") ? "embree-fast-high-1"
                                                                 : "embree-fast-1";
  const auto build = static_cast<std::size_t>(Work::Build);
  best[build] = fastest(rows, [&](const std::string& m) { return m == quality; })[build];
  return best;
}

// A frame compares with as many of the peer's camera rays, which have been made for it.
void add_ratios(std::size_t pixels, Baseline baseline, std::vector<Row>& rows) {
  for (Row& row : rows) {
    std::array<double, kWorkCount> base = baseline_of(row.method, baseline, rows);
    const double camera = base[static_cast<std::size_t>(Work::Camera)];
    base[static_cast<std::size_t>(Work::Frame)] =
        camera == 0 ? 0 : static_cast<double>(pixels) / camera * 1e-3;
    for (const Work work : kWorks) {
      Cell& cell = cell_of(row, work);
      const double figure = base[static_cast<std::size_t>(work)];
      if (cell.figure == 0 || figure == 0) continue;
      cell.ratio = is_rate(work) ? cell.figure / figure : figure / cell.figure;
    }
  }
}

std::string three_digits(double value) {
  std::ostringstream text;
  const int decimals = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
  text << std::fixed << std::setprecision(decimals) << value;
  return text.str();
}

std::string text_of(const Cell& cell) {
  if (cell.figure == 0) return "";
  if (cell.ratio == 0) return three_digits(cell.figure);
  return "**" + three_digits(cell.ratio) + "** (" + three_digits(cell.figure) + ")";
}

}  // namespace

std::vector<Row> measure(const std::vector<Task>& tasks, int rounds, int threads, Baseline baseline,
                         const std::function<void(const Task&)>& after_check) {
  std::vector<Row> rows;
  std::size_t pixels = 0;
  for (const Task& task : tasks) {
    check(task, after_check, rows);
    if (task.work == Work::Frame) pixels = task.run();
    if (task.bytes) {
      row_of(rows, task).bytes_per_triangle =
          static_cast<double>(task.bytes()) / static_cast<double>(task.run());
    }
  }
  for (const Work work : kWorks) time_work(tasks, work, rounds, threads, rows);
  add_ratios(pixels, baseline, rows);
  return rows;
}

std::vector<Row> mean(const std::vector<std::vector<Row>>& tables) {
  std::vector<Row> rows = tables.front();
  const double share = 1.0 / static_cast<double>(tables.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < kWorkCount; ++c) {
      double figure = 0, ratio = 0;
      std::size_t wrong = 0;
      for (const std::vector<Row>& table : tables) {
        figure += std::log(table[r].cells[c].figure) * share;
        ratio += std::log(table[r].cells[c].ratio) * share;
        wrong += table[r].cells[c].wrong;
      }
      rows[r].cells[c] = {std::exp(figure), std::exp(ratio), wrong};  // exp(log(0)) is 0: not measured
    }
    double bytes = 0;
    for (const std::vector<Row>& table : tables) bytes += std::log(table[r].bytes_per_triangle) * share;
    rows[r].bytes_per_triangle = std::exp(bytes);
  }
  return rows;
}

void print_markdown(std::ostream& out, const std::vector<Row>& rows) {
  out << "| method | SIMD | camera Mrays/s | shadow Mrays/s | occlusion Mrays/s | diffuse Mrays/s | random "
         "Mrays/s | frame ms | build ms | bytes/triangle | other answers "
         "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    out << "| " << row.method << " | " << row.target;
    std::size_t wrong = 0;
    for (const Cell& cell : row.cells) {
      out << " | " << text_of(cell);
      wrong += cell.wrong;
    }
    out << " | " << (row.bytes_per_triangle == 0 ? "" : three_digits(row.bytes_per_triangle)) << " | "
        << wrong << " |\n";
  }
}

}  // namespace plumb::bench
