#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "report/speed_run.h"
#include "tool/run_tool.h"

using namespace plumb;
using namespace plumb::tool;
using plumb::test::run_tool;
using plumb::test::TempFolder;
using plumb::test::ToolRun;

namespace {

const std::string kSmall = "report builtin:grid:16 builtin:ties:2000 --size 96x54 --rounds 1 ";

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

// What a browser makes of the page, as text; empty where there is no browser.
std::string dom_of(const std::string& page) {
  if (std::system("command -v chromium > /dev/null 2>&1") != 0) return "";
  const TempFolder profile;
  const std::string command = "timeout 120 chromium --headless --no-sandbox --disable-gpu --user-data-dir='" +
                              profile.path().string() + "' --dump-dom 'file://" + page + "' 2>/dev/null";
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string text;
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe.get())) > 0;) text.append(buffer, n);
  return text;
}

}  // namespace

TEST_SUITE_BEGIN("tool: report, speed against error");

TEST_CASE("errors are counted by kind, and depths by how many floats they are off") {
  const float next = std::nextafter(2.0f, 3.0f);
  const std::vector<Hit> exact = {{1, 1}, {2, 2}, {3, 3}, {}, {2, 5}, {}};
  const std::vector<Hit> answers = {{1, 1}, {next, 2}, {}, {4, 4}, {2, 6}, {}};
  const Errors errors = errors_of(exact, answers);
  CHECK(errors.asked == 6);
  CHECK(errors.wrong_ids == 3);
  CHECK(errors.lost == 1);
  CHECK(errors.extra == 1);
  CHECK(errors.seen_right == 2);
  CHECK(errors.other_depths == 1);
  CHECK(errors.worst_ulps == 1);
  CHECK(errors.mean_ulps == 0.5);
  CHECK(errors.wrong_per_million() == doctest::Approx(500'000.0));
}

TEST_CASE("of 2000 depths, 1999 right, 99.9 % are right") {
  std::vector<Hit> exact(2000, Hit{1.0f, 7}), answers = exact;
  answers[5].t = 1.5f;
  const Errors errors = errors_of(exact, answers);
  CHECK(errors.ulps_999 == 0);
  CHECK(errors.worst_ulps == 1u << 22);
}

TEST_CASE("exact methods have no error, in every kind of work, and every one has its speed") {
  const ToolRun run = run_tool(kSmall + "--simd all --json");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  const auto json = nlohmann::json::parse(run.out);
  CHECK(json.at("agree") == true);
  REQUIRE(json.at("scenes").size() == 2);
  std::size_t exact_rows = 0;
  for (const auto& scene : json.at("scenes")) {
    for (const auto& row : scene.at("rows")) {
      const bool frames_only =
          row.at("method") == "raster" || row.at("method") == "tile" || row.at("method") == "auto";
      CHECK(row.at("camera_mrays").is_null() == frames_only);
      if (!row.at("exact").get<bool>()) continue;
      ++exact_rows;
      CHECK(row.at("frame_ms").get<double>() > 0.0);
      for (const char* errors : {"camera_errors", "diffuse_errors", "frame_errors"}) {
        if (row.at(errors).is_null()) continue;
        CHECK(row.at(errors).at("wrong_ids") == 0);
        CHECK(row.at(errors).at("other_depths") == 0);
      }
    }
  }
  CHECK(exact_rows >= 2 * 4);
}

TEST_CASE("the table names every method") {
  const ToolRun run = run_tool(kSmall);
  CHECK(run.status == 0);
  for (const char* method : {"raster", "tile", "bvh2", "bvh4", "bvh8", "ties:2000"})
    CHECK(count(run.out, method) > 0);
}

TEST_CASE("the page stands alone and shows tables, plots and pictures in a browser") {
  const TempFolder folder;
  const std::string page = (folder / "report.html").string();
  const ToolRun run = run_tool(kSmall + "--html " + page);
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  const std::string html = plumb::test::read_text(page);
  CHECK(count(html, "src=\"http") + count(html, "href=\"http") + count(html, "<link") +
            count(html, "<script") ==
        0);
  const std::string dom = dom_of(page);
  if (dom.empty()) {
    MESSAGE("skipped: no browser (chromium) is here");
    return;
  }
  CHECK(count(dom, "<h2>") == 2);
  CHECK(count(dom, "<table>") == 2);
  CHECK(count(dom, "<svg") == 4);
  CHECK(count(dom, "<img") >= 2);
  CHECK(count(dom, "data:image/png;base64,") == count(dom, "<img"));
  CHECK(count(dom, "Mrays/s") >= 4);
  CHECK(count(dom, ">bvh8<") >= 2);
}

TEST_CASE("what makes no sense ends in status 2") {
  for (const char* arguments :
       {"report --rounds 0", "report --size 0x5", "report --simd none", "report builtin:none",
        "report --threads -1", "report builtin:grid:2 --html /none/page.html"}) {
    CAPTURE(arguments);
    CHECK(run_tool(arguments).status == 2);
  }
}

TEST_SUITE_END();
