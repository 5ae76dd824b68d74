#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "plumb/simd.h"
#include "plumb/version.h"
#include "tool/run_tool.h"

namespace fs = std::filesystem;
using plumb::test::run_tool;
using plumb::test::TempFolder;
using plumb::test::ToolRun;

namespace {

const std::string kSmall = "builtin:teapot-in-stadium:2000 --size 32x18 --threads 1 ";

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_SUITE_BEGIN("tool: command line");

TEST_CASE("methods that agree end in status 0 and say so on standard error alone") {
  const ToolRun run = run_tool("compare " + kSmall + "--methods brute,bvh2,bvh4,bvh8,raster");
  CAPTURE(run.err);
  CHECK(run.status == 0);
  CHECK(run.out.empty());
  CHECK(has(run.err, "all 5 frames agree in every pixel"));
}

TEST_CASE("bad usage and bad input end in status 2 and name what is wrong") {
  struct Case {
    std::string arguments, named;
  };
  const std::vector<Case> cases = {
      {"", "subcommand"},
      {"compare --sizes 3x3", "--sizes"},
      {"compare --size", "--size"},
      {"compare a.ply b.ply", "b.ply"},
      {"compare /nowhere/mesh.ply", "/nowhere/mesh.ply"},
      {"compare /dev/null", "/dev/null"},
      {"compare builtin:nonesuch", "nonesuch"},
      {"compare builtin:grid:many", "many"},
      {"compare --size 0x5", "0x5"},
      {"compare --size 5", "'5'"},
      {"compare --size 5x", "'5x'"},
      {"compare --size 5x5x5", "5x5x5"},
      {"compare --size -5x5", "-5x5"},
      {"compare --size 65535x65535", "65535x65535"},
      {"compare --size 100000x1", "100000x1"},
      {"compare --methods bvh3", "bvh3"},
      {"compare --methods bvh2,", "''"},
      {"compare --methods bvh2,bvh2", "twice"},
      {"compare --simd mmx", "mmx"},
      {"compare --threads -1 " + kSmall, "threads"},
      {"compare --threads two", "two"},
      {"compare --eye 1,2", "1,2"},
      {"compare --eye 1,2,3,4", "1,2,3,4"},
      {"compare --eye 1,2,x", "'x'"},
      {"compare --eye 1,2,nan", "nan"},
      {"compare --eye 1,2,1e40", "1e40"},
      {"compare --target ''", "--target"},
      {"compare --fov wide", "wide"},
      {"compare --fov 180 " + kSmall, "180"},
      {"compare --eye 1,1,1 --target 1,1,1 " + kSmall, "target"},
      {"render --out frame.exr " + kSmall, "--method"},
      {"render --method bvh2 " + kSmall, "--out"},
      {"render --method bvh2 --out frame.png " + kSmall, "frame.png"},
      {"render --method bvh2 --out /nowhere/frame.exr " + kSmall, "/nowhere"},
      {"render --method bvh8 --simd all --out frame.exr " + kSmall, "all"},
      {"render --method bvh3 --out frame.exr " + kSmall, "bvh3"},
  };
  for (const Case& c : cases) {
    const ToolRun run = run_tool(c.arguments);
    CAPTURE(c.arguments);
    CAPTURE(run.err);
    CHECK(run.status == 2);
    CHECK(run.out.empty());
    CHECK(has(run.err, c.named));
  }
}

TEST_CASE("a file that cannot be written ends in status 2 and is named") {
  const TempFolder folder;
  fs::create_symlink("/dev/full", folder / "full.exr");
  const std::string full = (folder / "full.exr").string();
  const ToolRun render = run_tool("render " + kSmall + "--method bvh2 --out " + full);
  CAPTURE(render.err);
  CHECK(render.status == 2);
  CHECK(has(render.err, full));

  const std::string under_a_file = "/dev/null/pictures";
  const ToolRun compare = run_tool("compare " + kSmall + "--out " + under_a_file);
  CAPTURE(compare.err);
  CHECK(compare.status == 2);
  CHECK(has(compare.err, under_a_file));

  const ToolRun json = run_tool("compare --json " + kSmall, "> /dev/full");
  CAPTURE(json.err);
  CHECK(json.status == 2);
  CHECK(has(json.err, "standard output"));
}

TEST_CASE("help and version are printed on standard output with status 0") {
  const ToolRun version = run_tool("--version");
  CHECK(version.status == 0);
  CHECK(version.out == "plumb " PLUMB_VERSION "\n");
  for (const std::string part : {"compare", "render", "info", "soak", "report", "Exit status", "Examples"}) {
    CHECK(has(run_tool("--help").out, part));
  }
  for (const std::string command : {"info", "soak", "report"}) {
    const ToolRun help = run_tool(command + " --help");
    CHECK(help.status == 0);
    CHECK(help.err.empty());
    for (const std::string part : {"--threads", "--json", "Examples:\n", "Exit status: 0"}) {
      CAPTURE(part);
      CHECK(has(help.out, part));
    }
  }
  for (const std::string command : {"compare", "render"}) {
    const ToolRun help = run_tool(command + " --help");
    CHECK(help.status == 0);
    CHECK(help.err.empty());
    for (const std::string part :
         {"SCENE", "--size", "--eye", "--target", "--up", "--fov", "--simd", "--threads", "--out",
          "Examples:\n", "raster", "teapot-in-stadium", "Exit status"}) {
      CAPTURE(part);
      CHECK(has(help.out, part));
    }
  }
}

TEST_CASE("options and SCENE may come in any order") {
  const std::vector<std::string> orders = {
      "builtin:grid:4 --size 16x9 --eye -3,200000,900000 --methods bvh2,bvh8 --json",
      "--size 16x9 builtin:grid:4 --eye -3,200000,900000 --methods bvh2,bvh8 --json",
      "--json --methods bvh2,bvh8 --eye=-3,200000,900000 --size=16x9 builtin:grid:4",
      "--methods bvh2,bvh8 --json builtin:grid:4 --eye -3,200000,900000 --size 16x9",
  };
  std::vector<nlohmann::json> answers;
  for (const std::string& order : orders) {
    const ToolRun run = run_tool("compare " + order);
    CAPTURE(run.err);
    REQUIRE(run.status == 0);
    answers.push_back(nlohmann::json::parse(run.out));
    CHECK(answers.back()["scene"] == answers.front()["scene"]);
    CHECK(answers.back()["camera"] == answers.front()["camera"]);
    CHECK(answers.back()["pairs"] == answers.front()["pairs"]);
  }
  CHECK(answers.front()["scene"]["name"] == "builtin:grid:4");
  CHECK(answers.front()["camera"]["eye"] == nlohmann::json({-3.0, 200000.0, 900000.0}));
}

TEST_CASE("--json holds what docs/tool.md says") {
  const TempFolder folder;
  const ToolRun run =
      run_tool("compare --json --methods bvh2,bvh4 --out " + folder.path().string() + " " + kSmall);
  REQUIRE(run.status == 0);
  const nlohmann::json json = nlohmann::json::parse(run.out);
  CHECK(json["plumb"] == PLUMB_VERSION);
  CHECK(json["agree"] == true);
  CHECK(json["threads"] == 1);
  CHECK(json["scene"]["triangles"].get<int>() > 1000);
  CHECK(json["camera"]["width"] == 32);
  CHECK(json["camera"]["height"] == 18);
  REQUIRE(json["runs"].size() == 2);
  CHECK(json["runs"][0]["method"] == "bvh2");
  CHECK(json["runs"][0]["simd"].is_null());
  CHECK(json["runs"][1]["simd"] == std::string(plumb::simd_name(plumb::simd_targets().front())));
  CHECK(json["runs"][1]["frame_seconds"].get<double>() > 0.0);
  CHECK(json["runs"][1]["seen_pixels"] == json["runs"][0]["seen_pixels"]);
  for (const std::string file : json["runs"][1]["files"]) CHECK(fs::is_regular_file(file));
  REQUIRE(json["pairs"].size() == 1);
  CHECK(json["pairs"][0]["a"] == "bvh2");
  CHECK(json["pairs"][0]["b"] == "bvh4");
  CHECK(json["pairs"][0]["pixels"] == 32 * 18);
  CHECK(json["pairs"][0]["different_pixels"] == 0);
  CHECK(json["pairs"][0]["first"].empty());
  CHECK(json["pairs"][0]["picture"].is_null());
}

TEST_CASE("--simd all runs every target, and a scalar method once") {
  const ToolRun run = run_tool("compare --json --simd all --methods bvh2,bvh4,raster " + kSmall);
  REQUIRE(run.status == 0);
  const std::vector<plumb::Simd> targets = plumb::simd_targets();
  const bool one_target = targets.size() == 1;
  std::vector<std::string> expected = {"bvh2"};
  for (const std::string method : {"bvh4", "raster"}) {
    for (const plumb::Simd target : targets) {
      expected.push_back(one_target ? method : method + "-" + std::string(plumb::simd_name(target)));
    }
  }
  std::vector<std::string> names;
  const nlohmann::json json = nlohmann::json::parse(run.out);
  for (const nlohmann::json& entry : json["runs"]) names.push_back(entry["name"]);
  CHECK(names == expected);
}

TEST_SUITE_END();
