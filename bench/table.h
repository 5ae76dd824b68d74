#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "task.h"

namespace plumb::bench {

/// What a method does at one kind of work: its speed (Mrays/s, or ms for a frame or build), the ratio of its
/// speed to the peer's, and how many answers are wrong. Zero: not measured.
struct Cell {
  double figure = 0;
  double ratio = 0;
  std::size_t wrong = 0;
};

struct Row {
  std::string method, target;
  bool exact = true;
  std::array<Cell, kWorkCount> cells;
  double bytes_per_triangle = 0;
};

/// What speeds are given as multiples of: Embree's single-ray call, or scene by scene the fastest of all its
/// calls on all its trees (fast mode), and for builds the one of the same quality.
enum class Baseline { SingleRays, Best };

/// Checks all tasks, then times them, those of one kind of work in turns. Throws plumb::Error when an exact
/// method's answers are not the reference's: then nothing is timed. With `after_check` that is for the caller
/// to judge: it is called after each check, when the task's answers are still in the workload.
std::vector<Row> measure(const std::vector<Task>& tasks, int rounds, int threads, Baseline baseline,
                         const std::function<void(const Task&)>& after_check = nullptr);

/// The geometric mean of each cell over tables of the same rows.
std::vector<Row> mean(const std::vector<std::vector<Row>>& tables);

void print_markdown(std::ostream& out, const std::vector<Row>& rows);

}  // namespace plumb::bench
