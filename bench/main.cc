// Builds, rays and frames by every method, width and instruction set: as Google Benchmark's list, or
// with --table as tables in Markdown. kUsage says how to call it.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "embree_peer.h"
#include "llvmpipe_peer.h"
#include "machine.h"
#include "options.h"
#include "ours.h"
#include "table.h"

namespace plumb::bench {
namespace {

// Trees kept at once: in a table all that its methods take turns with, in a list the one in use.
constexpr std::size_t kTreesOfTable = 64;
constexpr std::size_t kTreesOfList = 1;

using Workloads = std::shared_ptr<Shelf<Workload>>;

std::vector<Task> all_tasks(const ViewName& name, const Options& options, int threads, std::size_t trees,
                            const Workloads& workloads) {
  const int width = options.width, height = options.height;
  const auto workload = [=] {
    return workloads->get(name.title(), [&] { return make_workload(load_view(name, width, height)); });
  };
  const Context context{name, threads, trees, options.peer_isa, workload};
  std::vector<Task> tasks = our_tasks(context, options.targets);
  for (Task& task : embree_tasks(context)) tasks.push_back(std::move(task));
  for (Task& task : llvmpipe_tasks(context)) tasks.push_back(std::move(task));
  const auto wants = [](const std::vector<std::string>& wanted, const std::string& name_of) {
    return wanted.empty() || std::find(wanted.begin(), wanted.end(), name_of) != wanted.end();
  };
  const auto unwanted = [&](const Task& task) {
    return !wants(options.methods, task.method) || !wants(options.works, work_name(task.work));
  };
  std::erase_if(tasks, unwanted);
  return tasks;
}

void run_benchmark(benchmark::State& state, const Task& task) {
  const std::size_t wrong = task.check();
  if (task.exact && wrong != 0) {
    state.SkipWithError((std::to_string(wrong) + " answers differ from the binary BVH's").c_str());
    return;
  }
  std::size_t done = 0;
  for (auto _ : state) done = task.run();
  const char* const unit = task.work == Work::Build ? "triangles/s" : "rays/s";
  state.counters[unit] =
      benchmark::Counter(static_cast<double>(done), benchmark::Counter::kIsIterationInvariantRate);
  if (!task.exact) state.counters["wrong"] = static_cast<double>(wrong);
}

void add_benchmark(const Task& task, const ViewName& name, int threads) {
  const std::string target = task.target.empty() ? "" : "/" + task.target;
  const std::string title = std::string(work_name(task.work)) + "/" + task.method + target +
                            "/threads:" + std::to_string(threads) + "/" + name.title();
  auto* const bench = benchmark::RegisterBenchmark(
      title.c_str(), [task](benchmark::State& state) { run_benchmark(state, task); });
  bench->Unit(benchmark::kMillisecond);
  if (threads == 1) {
    bench->MeasureProcessCPUTime();
  } else {
    bench->UseRealTime();
  }
}

void run_list(const Options& options) {
  const auto workloads = std::make_shared<Shelf<Workload>>(1);
  for (const ViewName& name : options.views) {
    for (const int threads : options.threads) {
      for (const Task& task : all_tasks(name, options, threads, kTreesOfList, workloads)) {
        add_benchmark(task, name, threads);
      }
    }
  }
  benchmark::RunSpecifiedBenchmarks();
}

std::string vector_text(const glm::dvec3& v) {
  std::ostringstream text;
  text << "(" << v.x << ", " << v.y << ", " << v.z << ")";
  return text.str();
}

void print_view(const ViewName& name, const Workload& workload, int threads) {
  const Camera& camera = workload.view.camera;
  const glm::dvec3 towards = camera.corner + 0.5 * camera.width * camera.du + 0.5 * camera.height * camera.dv;
  std::cout << "\n### " << name.title() << ", " << threads << (threads == 1 ? " thread" : " threads")
            << "\n\n"
            << workload.view.mesh.triangles.size() << " triangles; camera at " << vector_text(camera.eye)
            << " towards " << vector_text(towards) << ", " << camera.width << "x" << camera.height
            << " pixels, " << workload.shadow.rays.size()
            << " of them see something. Load: " << machine_load() << ".\n\n";
}

void print_head(const Options& options) {
  std::cout << machine_name() << "; " << compiler_name() << "; medians of " << options.rounds << " rounds.\n";
  const std::string rasterizer = llvmpipe_version();
  if (!rasterizer.empty()) {
    std::cout << "`llvmpipe` is Mesa's " << rasterizer
              << ", drawing into 32 bits of id and depth from buffers that stay, without reading back; on "
              << options.threads.front() << " thread(s).\n";
  }
  const std::string peer = embree_version();
  if (peer.empty()) return;
  const std::string baseline = options.peers ? "the fastest of the calls and trees of its fast mode that are "
                                               "listed, for `-single` of its single-ray calls and for builds "
                                               "that of the same quality"
                                             : std::string("`") + kEmbreeBaseline + "`";
  std::cout << "In bold the speed as a multiple of " << baseline << " (" << peer
            << ") in the same run, a frame's as a multiple of its camera rays'; then the figure itself.\n";
}

void print_tables(const Options& options) {
  print_head(options);
  for (const int threads : options.threads) {
    std::vector<std::vector<Row>> tables;
    for (const ViewName& name : options.views) {
      const auto workloads = std::make_shared<Shelf<Workload>>(1);
      const std::vector<Task> tasks = all_tasks(name, options, threads, kTreesOfTable, workloads);
      const std::vector<Row> rows =
          measure(tasks, options.rounds, threads, options.peers ? Baseline::Best : Baseline::SingleRays);
      const std::shared_ptr<Workload> workload = workloads->get(name.title(), nullptr);
      print_view(name, *workload, threads);
      print_markdown(std::cout, rows);
      std::cout.flush();
      tables.push_back(rows);
    }
    if (tables.size() > 1) {
      std::cout << "\n### Geometric mean of " << tables.size() << " views, " << threads
                << (threads == 1 ? " thread" : " threads") << "\n\n";
      print_markdown(std::cout, mean(tables));
    }
  }
}

}  // namespace
}  // namespace plumb::bench

int main(int argc, char** argv) {
  using namespace plumb::bench;
  benchmark::Initialize(&argc, argv);
  try {
    const Options options = parse_options(argc, argv);
    set_llvmpipe_threads(options.threads.front());
    if (options.help) {
      std::cout << kUsage;
    } else if (options.table) {
      print_tables(options);
    } else {
      run_list(options);
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << "\n";
    return 2;
  }
  return 0;
}
