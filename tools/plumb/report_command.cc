#include <algorithm>
#include <cstdio>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "output_file.h"
#include "plumb/error.h"
#include "progress_bar.h"
#include "report/hard_document.h"
#include "report/hard_run.h"
#include "scene.h"
#include "text.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

struct ReportOptions {
  bool hard = false;
  HardOptions run;
  std::optional<std::string> out;
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
      R"(--hard draws scenes of each hard case, asks every method on every instruction set and the peers of this
build, and compares each answer with rational arithmetic.

Examples:
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

ExitStatus run_report(const ReportOptions& options) {
  if (!options.hard) throw Error("plumb: report: say which report; there is --hard");
  check_threads(options.run.threads);
  if (options.run.instances == 0) throw Error("plumb: --instances 0: give 1 or more");
  return run_hard(options);
}

}  // namespace

void add_report_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("report", "Show how exact plumb is, and what else there is");
  const auto options = std::make_shared<ReportOptions>();
  command->add_flag("--hard", options->hard, "hard cases: every method and peer against exact arithmetic");
  command->add_option("--seed", options->run.seed, "of what is drawn; another seed draws other instances")
      ->type_name("S")
      ->capture_default_str();
  command
      ->add_option("--instances", options->run.instances, "scenes a case; costly cases have a share of them")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--cases", options->run.cases, "only these, with commas between")->type_name("LIST");
  add_threads_option(*command, options->run.threads);
  command->add_option("--out", options->out, "write the report as Markdown")->type_name("FILE.md");
  command->add_flag("--json", options->json, "print the report as JSON on standard output");
  command->footer(report_help());
  command->callback([options, &status] { status = run_report(*options); });
}

}  // namespace plumb::tool
