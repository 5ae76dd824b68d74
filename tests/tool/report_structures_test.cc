#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "report/structures_run.h"
#include "tool/run_tool.h"

using namespace plumb;
using namespace plumb::tool;
using plumb::test::run_tool;
using plumb::test::TempFolder;
using plumb::test::ToolRun;

namespace {

const std::string kSmall =
    "report --structures builtin:cornell builtin:soup:3000 --greatest 1000 --size 32x18 --rounds 1 ";

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

}  // namespace

TEST_SUITE_BEGIN("tool: report, structures");

TEST_CASE("the exponent of a power is found, and points without a value are left out") {
  CHECK(fitted_exponent({1, 10, 100}, {5, 50, 500}) == doctest::Approx(1.0));
  CHECK(fitted_exponent({1, 10, 100, 1000}, {2, 0, 200, 2000}) == doctest::Approx(1.0));
  CHECK(fitted_exponent({4, 16}, {3, 6}) == doctest::Approx(0.5));
  CHECK(std::isnan(fitted_exponent({4}, {3})));
  CHECK(std::isnan(fitted_exponent({4, 4}, {3, 6})));
}

TEST_CASE("--structures measures every structure, all of which agree") {
  const ToolRun run = run_tool(kSmall + "--json");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  const nlohmann::json json = nlohmann::json::parse(run.out);
  CHECK(json["agree"] == true);
  REQUIRE(json["scenes"].size() == 2);
  // Three trees of boxes besides the other kinds; of many triangles not by brute force, which
  // the soup of 3000 still is.
  for (const nlohmann::json& scene : json["scenes"]) {
    CHECK(scene["structures"].size() == structure_kinds().size() + 2);
    for (const nlohmann::json& row : scene["structures"]) {
      CAPTURE(row["structure"].get<std::string>());
      CHECK(row["wrong"] == 0);
      CHECK(row["references"].get<std::size_t>() >= scene["triangles"].get<std::size_t>());
      CHECK(row["camera"]["mrays_per_second"].get<double>() > 0.0);
      CHECK(row["camera"]["triangles"].get<double>() > 0.0);
    }
  }
  REQUIRE(json["series"].size() == 3);
  CHECK(json["series"][0]["x"].size() == 2);
  CHECK(json["series"][2]["scenes"].size() == 5);
}

TEST_CASE("--structures --out writes the document and its plots") {
  const TempFolder folder;
  const ToolRun run = run_tool(kSmall + "--out " + (folder / "found.md").string());
  if (run.err.find("gnuplot") != std::string::npos) {
    MESSAGE("no gnuplot: skipped");
    return;
  }
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  const std::string text = text_of(folder / "found.md");
  CHECK(text.find("and none differed") != std::string::npos);
  CHECK(text.find("Right, within a tenth, in ") != std::string::npos);
  CHECK(text.find("## When to use which") != std::string::npos);
  int plots = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.path().extension() != ".svg") continue;
    ++plots;
    CHECK(text.find("](" + entry.path().filename().string() + ")") != std::string::npos);
    CHECK(text_of(entry.path()).find("bvh8") != std::string::npos);
  }
  CHECK(plots == 6);
}

TEST_CASE("--structures wants sensible numbers and no other report") {
  CHECK(run_tool("report --structures --hard").status == 2);
  const ToolRun run = run_tool("report --structures --greatest 9");
  CHECK(run.status == 2);
  CHECK(run.err.find("--greatest 9") != std::string::npos);
}

TEST_SUITE_END();
