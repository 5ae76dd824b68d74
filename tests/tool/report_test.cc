#include <doctest/doctest.h>

#include <cstddef>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "cases/cases.h"
#include "report/hard_document.h"
#include "report/hard_run.h"
#include "tool/run_tool.h"

using nlohmann::json;
using plumb::test::read_text;
using plumb::test::run_tool;
using plumb::test::TempFolder;
using plumb::test::ToolRun;
using plumb::tool::Answerer;
using plumb::tool::Answers;
namespace cases = plumb::cases;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// Whether each of plumb's methods was asked everything, on at least `methods` methods and targets, and was
// right in every bit. What peers do depends on the machine.
bool all_right(const json& asked, std::size_t methods) {
  std::size_t right = 0;
  for (const json& answer : asked["answers"]) {
    const std::string method = answer["method"];
    if (method.starts_with("embree") || method == "llvmpipe") continue;
    if (answer["asked"] != asked["count"] || answer["different"] != 0) return false;
    ++right;
  }
  return asked["count"] == 0 || right >= methods;
}

// A method that answers every ray and pixel in one way.
Answerer constant(const plumb::Hit& hit) {
  return {"constant", "", "", "", [hit](const cases::Instance& instance) {
            return Answers{std::vector<std::optional<plumb::Hit>>(instance.rays.size(), hit), {}};
          }};
}

}  // namespace

TEST_SUITE_BEGIN("tool: report");

TEST_CASE("a small part of docs/hard-cases.md is what it was on any machine, and plumb right in all of it") {
  const ToolRun run = run_tool("report --hard --seed 1 --instances 12 --json");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  CHECK(has(run.err, "answers of plumb's methods and instruction sets: all exact"));
  const json report = json::parse(run.out);
  CHECK(report["agree"] == true);
  std::ostringstream made;
  for (const json& c : report["cases"]) {
    CAPTURE(c["name"]);
    CHECK(all_right(c["rays"], 4));
    CHECK(all_right(c["pixels"], 5));
    made << c["name"].get<std::string>() << ' ' << c["instances"] << ' ' << c["rays"]["count"] << ' '
         << c["rays"]["seen"] << ' ' << c["pixels"]["count"] << ' ' << c["pixels"]["seen"] << '\n';
  }
  CHECK(made.str() == read_text(PLUMB_TESTS_DIR "/tool/hard_cases_expected.txt"));
}

TEST_CASE(
    "peers are asked properly: where nothing ties and nothing is extreme they are nearly always right") {
  const ToolRun run =
      run_tool("report --hard --instances 30 --cases equal-boxes,one-triangle,grazing --json");
  REQUIRE(run.status == 0);
  const json whole = json::parse(run.out);
  for (const json& c : whole["cases"]) {
    for (const json& answer : c["pixels"]["answers"]) {
      CAPTURE(c["name"]);
      CAPTURE(answer["method"]);
      CHECK(answer["wrong_ids"].get<double>() <= 0.03 * answer["asked"].get<double>());
      CHECK(answer["worst_ulps"] < 10'000);
    }
  }
}

TEST_CASE("docs/hard-cases.md has every case as it is now, and no difference of plumb's") {
  const std::string document = read_text(PLUMB_DOCS_DIR "/hard-cases.md");
  for (const cases::Case& c : cases::all_cases()) {
    CAPTURE(c.name);
    const std::string name(c.name);
    CHECK(has(document,
              "\n### " + name + "\n\n" + std::string(c.built) + "\n\n*" + std::string(c.definition) + "*\n"));
    const std::string row = document.substr(document.find("| [" + name + "](#" + name + ") |"));
    std::istringstream cells(row.substr(0, row.find('\n')));
    std::string cell;
    for (int i = 0; i < 5; ++i) std::getline(cells, cell, '|');
    CHECK(cell == " 0 ");
  }
}

TEST_CASE("--out writes Markdown of the cases asked for") {
  const TempFolder folder;
  const ToolRun run = run_tool("report --hard --instances 3 --cases fan-vertex,tmin-at-hit --out " +
                               (folder / "report.md").string());
  CAPTURE(run.err);
  CHECK(run.status == 0);
  CHECK(run.out.empty());
  const std::string document = read_text(folder / "report.md");
  CHECK(has(document, "`plumb report --hard --seed 1 --instances 3 --cases fan-vertex,tmin-at-hit`"));
  CHECK(has(document, "### fan-vertex"));
  CHECK(has(document, "3 scenes, 24 rays of which 100 % see something."));
  CHECK(has(document,
            "| rays: brute, bvh2, spheres, bvh4, bvh4-fast-build, bvh4-best-build, bvh8, bvh8-fast-build, "
            "bvh8-best-build, bvh8-compact, kdtree, grid, octree | 24 | 0 | 0 | 0 | 0 | 0 | 0 | 0 |"));
  CHECK(!has(document, "### shared-edge"));
}

TEST_CASE("a method that is wrong is found, counted and named") {
  const cases::Case& fan = *cases::find_case("fan-vertex");
  plumb::tool::HardOptions options;
  options.instances = 10;
  plumb::tool::HardReport report{options, {constant(plumb::Hit{})}, {}};
  report.cases.push_back(plumb::tool::run_case(fan, report.answerers, options, {}));
  const plumb::tool::CaseResult& result = report.cases[0];
  CHECK(result.rays.count == 80);
  CHECK(result.rays.seen == 80);
  CHECK(result.rays.tallies[0].asked == 80);
  CHECK(result.rays.tallies[0].lost == 80);
  CHECK(result.differences.size() == 4);
  CHECK(has(result.differences[0], "fan-vertex, seed 1, instance "));
  CHECK(!report.agrees());
  const std::string document = plumb::tool::to_markdown(report);
  CHECK(has(document, "| [fan-vertex](#fan-vertex) | 80 | 0 | 80 |"));
  CHECK(has(document, "| rays: constant  | 80 | 80 | 80 | 0 | 0 | 0 | 0 | 0 |"));
  CHECK(json::parse(plumb::tool::to_json(report))["agree"] == false);
}

TEST_CASE("bad usage of report ends in status 2 and names what is wrong") {
  struct Usage {
    std::string arguments, named;
  };
  const std::vector<Usage> usages = {
      {"report --hard --instances 0", "--instances"},
      {"report --hard --instances many", "many"},
      {"report --hard --threads -1", "--threads"},
      {"report --hard --cases nonesuch", "nonesuch"},
      {"report --hard --instances 1 --cases no-triangle --out /nowhere/a.md", "/nowhere"},
  };
  for (const Usage& usage : usages) {
    const ToolRun run = run_tool(usage.arguments);
    CAPTURE(usage.arguments);
    CAPTURE(run.err);
    CHECK(run.status == 2);
    CHECK(has(run.err, usage.named));
    CHECK(run.out.empty());
  }
}
