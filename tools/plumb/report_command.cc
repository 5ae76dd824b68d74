#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "bench/embree_peer.h"
#include "bench/machine.h"
#include "commands.h"
#include "output_file.h"
#include "plumb/error.h"
#include "plumb/simd.h"
#include "progress_bar.h"
#include "report/hard_document.h"
#include "report/hard_run.h"
#include "report/plot.h"
#include "report/speed_run.h"
#include "report/structures_run.h"
#include "scene.h"
#include "text.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

struct ReportOptions {
  bool hard = false, structures = false;
  HardOptions run;
  std::optional<std::string> out;
  SpeedOptions speed;
  std::size_t greatest = 1'000'000;  // of --structures
  std::string size = "640x360", simd = "auto";
  std::optional<std::string> html;
  bool json = false;
};

std::vector<const cases::Case*> parse_cases(const std::string& list) {
  std::vector<const cases::Case*> chosen;
  if (list.empty()) {
    for (const cases::Case& hard_case : cases::all_cases()) chosen.push_back(&hard_case);
    return chosen;
  }
  for (const std::string& name : split_list(list)) {
    const cases::Case* found = cases::find_case(name);
    if (found == nullptr) {
      throw Error(fmt::format("plumb: --cases {}: no case is called '{}'; --help lists them", list, name));
    }
    chosen.push_back(found);
  }
  return chosen;
}

std::string report_help() {
  std::string text =
      R"(Times every arithmetic, method and instruction set, and the peers of this build, in turns on the same rays,
and shows beside each how many triangles per million are wrong and how far off the depths are, against the
exact answers: on standard output, as JSON, or as a page (which needs gnuplot).

--hard draws scenes of each hard case, asks every method on every instruction set and the peers of this
build, and compares each answer with rational arithmetic.

--structures times builds and rays of every structure, counts what they test, and says when to use which.

Examples:
  plumb report --html report.html
  plumb report --structures --out structures.md
  plumb report bunny.ply builtin:ties --simd all --json
  plumb report --hard --out hard-cases.md
  plumb report --hard --cases sliver,shared-edge --instances 100 --json

Hard cases:
)";
  for (const cases::Case& hard_case : cases::all_cases()) {
    fmt::format_to(std::back_inserter(text), "  {}\n", hard_case.name);
  }
  return text +
         "\nExit status: 0 no answer of plumb's methods differs from the exact one, 1 some do, 2 bad "
         "usage.\n";
}

std::vector<Answerer> all_answerers() {
  std::vector<Answerer> all = plumb_answerers();
  for (const auto& peers : {embree_answerers(), llvmpipe_answerers()}) {
    all.insert(all.end(), peers.begin(), peers.end());
  }
  return all;
}

ExitStatus run_hard(const ReportOptions& options) {
  const std::vector<const cases::Case*> chosen = parse_cases(options.run.cases);
  HardReport report{options.run, all_answerers(), {}};
  for (const cases::Case* hard_case : chosen) {
    report.cases.push_back(
        run_case(*hard_case, report.answerers, options.run, progress_bar(std::string(hard_case->name))));
    fmt::print(stderr, "  {}\n", summary(report.cases.back(), report.answerers));
  }
  if (options.out) {
    const std::string text = to_markdown(report);
    write_file(*options.out, std::as_bytes(std::span(text)));
    fmt::print(stderr, "wrote {}\n", *options.out);
  }
  const Tally total = report.plumb_total();
  fmt::print(
      stderr, "{} answers of plumb's methods and instruction sets: {}\n", total.asked,
      total.different == 0 ? "all exact" : fmt::format("{} DIFFER from the exact ones", total.different));
  if (options.json) print_line(to_json(report));
  return report.agrees() ? kAgree : kDiffer;
}

const std::vector<std::string>& default_scenes() {
  static const std::vector<std::string> scenes = {"builtin:teapot-in-stadium", "builtin:spheres",
                                                  "builtin:grid", "builtin:ties"};
  return scenes;
}

SpeedOptions speed_options(const ReportOptions& options) {
  SpeedOptions speed = options.speed;
  if (speed.rounds < 1) throw Error(fmt::format("plumb: --rounds {}: give 1 or more", speed.rounds));
  if (speed.scenes.empty()) speed.scenes = default_scenes();
  std::tie(speed.width, speed.height) = parse_size("--size", options.size);
  speed.threads = options.run.threads.value_or(1);
  if (speed.threads == 0) speed.threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  if (options.simd == "all") {
    speed.targets = simd_targets();
  } else {
    speed.targets = {options.simd == "auto" ? simd_targets().front() : parse_simd(options.simd)};
  }
  return speed;
}

// Throws plumb::Error where nothing can be plotted: before the work, not after.
void check_plots() { plot_svg({"", "", "", {{"", 1.0, 1.0, 0}}, {""}}); }

ExitStatus run_speed(const ReportOptions& options) {
  SpeedReport report{
      speed_options(options), bench::machine_name(), bench::compiler_name(), bench::embree_version(), {}};
  if (options.html) check_plots();
  for (const std::string& scene : report.options.scenes) {
    report.scenes.push_back(measure_scene(scene, report.options, progress_bar(scene)));
    fmt::print(stderr, "measured {}\n", scene);
  }
  if (options.html) {
    const std::string page = speed_page(report);
    write_file(*options.html, std::as_bytes(std::span(page)));
    fmt::print(stderr, "wrote {}\n", *options.html);
  }
  print_line(options.json ? speed_json(report) : speed_table(report));
  return report.agrees() ? kAgree : kDiffer;
}

// One of each kind that favours some structure.
const std::vector<std::string>& structure_scenes() {
  static const std::vector<std::string> scenes = {
      "builtin:cornell",        "builtin:soup:200000", "builtin:terrain:200000",   "builtin:grass:200000",
      "builtin:spheres:200000", "builtin:quads",       "builtin:teapot-in-stadium"};
  return scenes;
}

// FILE.md and, beside it, the plots as FILE-NAME.svg.
void write_structures(const StructuresReport& report, const std::string& out) {
  const std::filesystem::path path(out);
  const std::string stem = path.stem().string();
  const std::vector<NamedPlot> plots = structures_plots(report);
  const std::string text = structures_markdown(report, plots, stem);
  write_file(out, std::as_bytes(std::span(text)));
  for (const NamedPlot& plot : plots) {
    write_file((path.parent_path() / fmt::format("{}-{}.svg", stem, plot.name)).string(),
               std::as_bytes(std::span(plot.svg)));
  }
  fmt::print(stderr, "wrote {} and {} plots beside it\n", out, plots.size());
}

ExitStatus run_structures(const ReportOptions& options) {
  const SpeedOptions speed = speed_options(options);
  StructuresOptions run;
  run.scenes = options.speed.scenes.empty() ? structure_scenes() : options.speed.scenes;
  run.width = speed.width;
  run.height = speed.height;
  run.rounds = speed.rounds;
  run.threads = speed.threads;
  run.greatest = options.greatest;
  if (run.greatest < 100) throw Error(fmt::format("plumb: --greatest {}: give 100 or more", run.greatest));
  if (options.out) check_plots();
  const StructuresReport report =
      measure_structures(run, [](const std::string& scene) { fmt::print(stderr, "measuring {}\n", scene); });
  if (options.out) write_structures(report, *options.out);
  if (options.json) print_line(structures_json(report));
  if (!options.out && !options.json) print_line(structures_markdown(report, {}, ""));
  return report.agrees() ? kAgree : kDiffer;
}

ExitStatus run_report(const ReportOptions& options) {
  check_threads(options.run.threads.value_or(0));
  if (options.hard && options.structures)
    throw Error("plumb: --hard and --structures are two reports: give one");
  if (options.structures) return run_structures(options);
  if (!options.hard) return run_speed(options);
  if (options.run.instances == 0) throw Error("plumb: --instances 0: give 1 or more");
  return run_hard(options);
}

}  // namespace

void add_report_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("report", "Show how exact plumb is, and what else there is");
  const auto options = std::make_shared<ReportOptions>();
  command->add_option(
      "SCENE", options->speed.scenes,
      "mesh files or builtin:NAME[:SIZE], of which speed is shown against error; a few built-in ones");
  command->add_option("--size", options->size, "the frame in pixels")
      ->type_name("WxH")
      ->capture_default_str();
  command->add_option("--simd", options->simd, "instruction set: auto (the best), a name, or all")
      ->type_name("NAME")
      ->capture_default_str();
  command->add_option("--rounds", options->speed.rounds, "how often each is timed; medians count")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--html", options->html, "write one page with tables, plots and pictures")
      ->type_name("FILE.html");
  command->add_flag("--hard", options->hard,
                    "instead, hard cases: every method and peer against exact arithmetic");
  command->add_flag(
      "--structures", options->structures,
      "instead, every structure on the SCENEs or some that favour one or another, and on growing ones");
  command
      ->add_option("--greatest", options->greatest,
                   "--structures: triangles of the largest scene of a series that grows")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--seed", options->run.seed, "of what is drawn; another seed draws other instances")
      ->type_name("S")
      ->capture_default_str();
  command
      ->add_option("--instances", options->run.instances, "scenes a case; costly cases have a share of them")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--cases", options->run.cases, "only these, with commas between")->type_name("LIST");
  command->add_option("--threads", options->run.threads, "0 takes all; 1 unless said, with --hard all")
      ->type_name("N");
  command->add_option("--out", options->out, "write the report as Markdown")->type_name("FILE.md");
  command->add_flag("--json", options->json, "print the report as JSON on standard output");
  command->footer(report_help());
  command->callback([options, &status] { status = run_report(*options); });
}

}  // namespace plumb::tool
