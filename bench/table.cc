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

bool is_rate(Work work) { return work == Work::Camera || work == Work::Shadow || work == Work::Diffuse; }

Row& row_of(std::vector<Row>& rows, const Task& task) {
  for (Row& row : rows) {
    if (row.method == task.method && row.target == task.target) return row;
  }
  rows.push_back({task.method, task.target, task.exact, {}});
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

// Rays and builds compare with the peer's; a frame with as many of its camera rays, which have been made
// for it.
void add_ratios(std::size_t pixels, std::vector<Row>& rows) {
  const auto peer =
      std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.method == kEmbreeBaseline; });
  if (peer == rows.end()) return;
  std::array<double, kWorkCount> baseline;
  for (const Work work : kWorks) baseline[static_cast<std::size_t>(work)] = cell_of(*peer, work).figure;
  baseline[static_cast<std::size_t>(Work::Frame)] =
      static_cast<double>(pixels) / cell_of(*peer, Work::Camera).figure * 1e-3;
  for (Row& row : rows) {
    for (const Work work : kWorks) {
      Cell& cell = cell_of(row, work);
      if (cell.figure == 0) continue;
      const double base = baseline[static_cast<std::size_t>(work)];
      cell.ratio = is_rate(work) ? cell.figure / base : base / cell.figure;
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

std::vector<Row> measure(const std::vector<Task>& tasks, int rounds, int threads,
                         const std::function<void(const Task&)>& after_check) {
  std::vector<Row> rows;
  std::size_t pixels = 0;
  for (const Task& task : tasks) {
    check(task, after_check, rows);
    if (task.work == Work::Frame) pixels = task.run();
  }
  for (const Work work : kWorks) time_work(tasks, work, rounds, threads, rows);
  add_ratios(pixels, rows);
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
  }
  return rows;
}

void print_markdown(std::ostream& out, const std::vector<Row>& rows) {
  out << "| method | SIMD | camera Mrays/s | shadow Mrays/s | diffuse Mrays/s | frame ms | build ms | other "
         "answers |\n|---|---|---|---|---|---|---|---|\n";
  for (const Row& row : rows) {
    out << "| " << row.method << " | " << row.target;
    std::size_t wrong = 0;
    for (const Cell& cell : row.cells) {
      out << " | " << text_of(cell);
      wrong += cell.wrong;
    }
    out << " | " << wrong << " |\n";
  }
}

}  // namespace plumb::bench
