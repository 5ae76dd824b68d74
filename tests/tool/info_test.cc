#include <fstream>
#include <string>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tool/run_tool.h"

using plumb::test::run_tool;
using plumb::test::TempFolder;
using plumb::test::ToolRun;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_SUITE_BEGIN("tool: info");

TEST_CASE("info says on standard output what a mesh and its trees are like") {
  const ToolRun run = run_tool("info builtin:spheres:8");
  CHECK(run.status == 0);
  CHECK(run.err.empty());
  CHECK(has(run.out, "triangles             8\n"));
  CHECK(has(run.out, "closed                yes\n"));
  CHECK(has(run.out, "Euler characteristic  2\n"));
  for (const char* tree : {"bvh2", "bvh4", "bvh8"}) CHECK(has(run.out, tree));
  const ToolRun open = run_tool("info builtin:terrain:2");
  CHECK(has(open.out, "closed                no: 4 edges of 5 with an odd number of triangles\n"));
  CHECK(has(open.out, "boundary              4 edges in 1 loop\n"));
}

TEST_CASE("info --json holds what docs/tool.md says") {
  const TempFolder folder;
  std::ofstream(folder / "odd.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nv 5 5 5\n"
                                    << "f 1 2 3\nf 3 2 1\nf 1 2 4\nf 1 1 2\n";
  const ToolRun run = run_tool("info " + (folder / "odd.obj").string() + " --width 4 --threads 1 --json");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  const auto json = nlohmann::json::parse(run.out);
  CHECK(json.at("scene").at("vertices") == 5);
  CHECK(json.at("scene").at("triangles") == 4);
  CHECK(json.at("scene").at("greatest") == nlohmann::json::array({5.0, 5.0, 5.0}));
  const auto& topology = json.at("topology");
  CHECK(topology.at("non_finite") == 1);
  CHECK(topology.at("collapsed") == 1);
  CHECK(topology.at("degenerate") == 1);
  CHECK(topology.at("duplicates") == 1);
  CHECK(topology.at("unused_vertices") == 1);
  CHECK(topology.at("triangles") == 2);
  CHECK(topology.at("closed") == true);
  REQUIRE(json.at("trees").size() == 1);
  const auto& tree = json.at("trees")[0];
  CHECK(tree.at("name") == "bvh4");
  CHECK(tree.at("unseen_triangles") == 1);
  CHECK(tree.at("bytes_per_triangle").get<double>() > 0.0);
}

TEST_CASE("info lists the triangles that half-edges cannot hold as they are") {
  const TempFolder folder;
  std::ofstream(folder / "fin.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 0 -1 0\n"
                                    << "f 3 4 5\nf 1 2 3\nf 1 2 4\nf 1 2 5\n";
  const ToolRun run = run_tool("info " + (folder / "fin.obj").string());
  CAPTURE(run.out);
  CHECK(has(run.out, "no half-edges for     3 triangles as they are: 1, 2, 3\n"));
  CHECK(has(run.out, "manifold              no: 1 edge of three triangles or more, "));
  CHECK(has(run.out, "components            2\n"));
  CHECK(has(run.out, "boundary              9 edges in 4 loops (of the surface taken apart"));
}

TEST_CASE("a file whose name is no text has info too") {
  const TempFolder folder;
  const std::string path = (folder / "\xff.off").string();
  std::ofstream(path) << "OFF\n0 0 0\n";
  const ToolRun run = run_tool("info --json '" + path + "'");
  CAPTURE(run.err);
  REQUIRE(run.status == 0);
  CHECK(nlohmann::json::parse(run.out)["scene"]["triangles"] == 0);
}

TEST_CASE("an empty mesh has info too") {
  const TempFolder folder;
  std::ofstream(folder / "empty.off") << "OFF\n0 0 0\n";
  const ToolRun run = run_tool("info " + (folder / "empty.off").string());
  CHECK(run.status == 0);
  CHECK(has(run.out, "box                   empty\n"));
  CHECK(has(run.out, "closed                no: there is nothing\n"));
  CHECK(run_tool("info " + (folder / "empty.off").string() + " --json").status == 0);
}

TEST_CASE("a width that is none, or a file that is none, ends in status 2") {
  CHECK(run_tool("info builtin:grid:2 --width 3").status == 2);
  CHECK(has(run_tool("info builtin:grid:2 --width 3").err, "--width 3"));
  CHECK(has(run_tool("info builtin:grid:2 --threads -2").err, "--threads -2"));
  CHECK(run_tool("info builtin:grid:2 --threads -2").status == 2);
  CHECK(run_tool("info /none.ply").status == 2);
  CHECK(run_tool("info --json builtin:grid:2", "> /dev/full").status == 2);
}

TEST_SUITE_END();
