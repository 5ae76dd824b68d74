#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "plumb/simd.h"
#include "report.h"
#include "tool/half_seen.h"
#include "tool/json_schema.h"
#include "tool/run_tool.h"

// What the tool prints with --json against docs/tool.schema.json, and both against docs/tool.md.

using nlohmann::json;
using plumb::test::run_tool;
using plumb::test::schema_errors;
using plumb::test::TempFolder;
using plumb::test::ToolRun;
using Errors = std::vector<std::string>;

namespace {

json schema() { return json::parse(plumb::test::read_text(PLUMB_DOCS_DIR "/tool.schema.json")); }

std::string page() { return plumb::test::read_text(PLUMB_DOCS_DIR "/tool.md"); }

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

// By the definition of its subcommand, and by the whole schema, which must tell the subcommands apart.
Errors errors_of(const json& value, const std::string& definition) {
  const json root = schema();
  Errors errors = schema_errors(root, root.at("$defs").at(definition), value);
  for (const std::string& error : schema_errors(root, root, value)) errors.push_back(error);
  return errors;
}

json printed(const std::string& arguments) {
  const ToolRun run = run_tool(arguments + " --json");
  CAPTURE(arguments);
  CAPTURE(run.err);
  CHECK(run.status == 0);
  return json::parse(run.out);
}

void collect_members(const json& schema, std::set<std::string>& names) {
  if (schema.is_array()) {
    for (const json& part : schema) collect_members(part, names);
  }
  if (!schema.is_object()) return;
  for (const auto& [keyword, argument] : schema.items()) {
    if (keyword == "properties") {
      for (const auto& [name, ignored] : argument.items()) names.insert(name);
    }
    collect_members(argument, names);
  }
}

}  // namespace

TEST_SUITE_BEGIN("tool: schema");

TEST_CASE("the JSON of compare follows the schema") {
  const TempFolder folder;
  const std::string small = "builtin:grid:4 --size 16x9 ";
  CHECK(errors_of(printed("compare " + small), "compare") == Errors{});
  CHECK(errors_of(printed("compare --methods brute,bvh2,bvh4,bvh8,raster --simd all --threads 1 --out " +
                          folder.path().string() + " " + small),
                  "compare") == Errors{});
  CHECK(errors_of(printed("compare --methods raster " + small), "compare") == Errors{});
}

TEST_CASE("the JSON of a comparison that differs follows the schema") {
  plumb::Frame other = plumb::test::half_seen();
  other.id[3] = 9;
  other.depth[3] = 1.5f;
  plumb::tool::CompareReport report;
  report.runs.resize(2);
  report.runs[0].run = {plumb::tool::Method::Bvh2, std::nullopt, "bvh2"};
  report.runs[0].build_seconds = 0.5;
  report.runs[0].files.emplace_back("bvh2.exr");
  report.runs[1].run = {plumb::tool::Method::Raster, plumb::simd_targets().front(), "raster"};
  report.pairs.push_back(
      {"bvh2", "raster", plumb::compare(plumb::test::half_seen(), other), "bvh2-raster.diff.png"});
  const plumb::tool::Scene scene = {"two frames",
                                    {},
                                    plumb::Camera({0, 0, 0}, {0, 0, -1}, {0.1, 0, 0}, {0, -0.1, 0},
                                                  plumb::test::kWidth, plumb::test::kHeight)};
  const json value = json::parse(plumb::tool::to_json(scene, 0, report));
  REQUIRE(value["pairs"][0]["first"].size() == 1);
  CHECK(errors_of(value, "compare") == Errors{});
}

TEST_CASE("the JSON of info follows the schema, for meshes of every kind") {
  CHECK(errors_of(printed("info builtin:terrain:200"), "info") == Errors{});
  CHECK(errors_of(printed("info builtin:spheres:8 --width 4"), "info") == Errors{});
  CHECK(errors_of(printed("info builtin:soup:50 --methods brute,kdtree,grid,octree,spheres"), "info") ==
        Errors{});
  const TempFolder folder;
  std::ofstream(folder / "empty.off") << "OFF\n0 0 0\n";
  std::ofstream(folder / "odd.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv nan 0 0\nv 9 9 9\n"
                                    << "f 1 2 3\nf 1 2 3\nf 1 2 4\nf 1 2 5\nf 1 1 2\n";
  CHECK(errors_of(printed("info " + (folder / "empty.off").string()), "info") == Errors{});
  CHECK(errors_of(printed("info " + (folder / "odd.obj").string()), "info") == Errors{});
}

TEST_CASE("the JSON of soak and of the reports follows the schema") {
  CHECK(errors_of(printed("soak --seconds 0.3 --threads 1"), "soak") == Errors{});
  CHECK(errors_of(printed("report --structures builtin:cornell --greatest 100 --size 16x9 --rounds 1"),
                  "report-structures") == Errors{});
  CHECK(errors_of(printed("report --hard --cases sliver,no-triangle --instances 3"), "report-hard") ==
        Errors{});
  CHECK(errors_of(printed("report builtin:cornell --size 32x18 --rounds 1"), "report") == Errors{});
}

TEST_CASE("the schema refuses what is wrong") {
  const json good = printed("info builtin:spheres:8 --width 4");
  const auto broken = [&](const char* pointer, const json& value) {
    json bad = good;
    bad[json::json_pointer(pointer)] = value;
    return errors_of(bad, "info");
  };
  CHECK(broken("/topology/edges", -1) ==
        Errors{"/topology/edges: -1.000000 is beyond 0", ": fits 0 schemas of oneOf"});
  CHECK(broken("/topology/closed", 1).front() == "/topology/closed: 1 is not of type \"boolean\"");
  CHECK(broken("/topology/more", 1).front() == "/topology: has \"more\" too");
  CHECK(broken("/trees/0/fill", 1.5).front() == "/trees/0/fill: 1.500000 is beyond 1");
  CHECK(broken("/advice/quality", "slow").front() ==
        "/advice/quality: \"slow\" is none of [\"fast\",\"balanced\"]");
  CHECK(broken("/trees/0/nodes", 1.5).front() == "/trees/0/nodes: 1.5 is not of type \"integer\"");
  CHECK(broken("/trees", json::array()).front() == "/trees: 0.000000 is beyond 1");
  CHECK(broken("/scene/least", json::array({1, 2})).front() == "/scene/least: 2.000000 is beyond 3");
  CHECK(broken("/plumb", "new").front() ==
        "/plumb: \"new\" does not match \"^[0-9]+\\\\.[0-9]+\\\\.[0-9]+$\"");
  json bad = good;
  bad["topology"].erase("edges");
  CHECK(errors_of(bad, "info").front() == "/topology: lacks \"edges\"");
  CHECK_THROWS(schema_errors({}, {{"minLength", 3}}, "abc"));
}

TEST_CASE("every member of the schema and every option is in docs/tool.md") {
  const std::string text = page();
  std::set<std::string> members;
  collect_members(schema(), members);
  CHECK(members.size() > 100);
  for (const std::string& member : members) {
    CAPTURE(member);
    CHECK(has(text, "`" + member + "`"));
  }
  CLI::App app;
  int status = 0;
  plumb::tool::add_compare_command(app, status);
  plumb::tool::add_render_command(app, status);
  plumb::tool::add_info_command(app, status);
  plumb::tool::add_soak_command(app, status);
  plumb::tool::add_report_command(app, status);
  for (const CLI::App* command : app.get_subcommands({})) {
    CHECK(has(text, "    plumb " + command->get_name() + " "));
    for (const CLI::Option* option : command->get_options()) {
      for (const std::string& name : option->get_lnames()) {
        CAPTURE(name);
        CHECK((has(text, "`--" + name + "`") || has(text, "`--" + name + " ")));
      }
    }
  }
}

TEST_SUITE_END();
