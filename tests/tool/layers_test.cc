#include <filesystem>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "plumb/builtin.h"
#include "plumb/raster.h"
#include "plumb/visible_triangles.h"
#include "tool/json_schema.h"
#include "tool/run_tool.h"

// compare --layers and render --visible.

namespace fs = std::filesystem;
using plumb::test::run_tool;
using plumb::test::TempFolder;
using plumb::test::ToolRun;

TEST_CASE("--layers compares every layer of every method, and writes each") {
  const TempFolder folder;
  const ToolRun run = run_tool(
      "compare builtin:soup:500 --size 40x30 --threads 1 --layers 3 --json "
      "--methods bvh2,bvh4,raster,kdtree,grid,octree,spheres,brute --out " +
      folder.path().string());
  REQUIRE(run.status == 0);
  const nlohmann::json json = nlohmann::json::parse(run.out);
  const nlohmann::json schema =
      nlohmann::json::parse(plumb::test::read_text(PLUMB_DOCS_DIR "/tool.schema.json"));
  CHECK(plumb::test::schema_errors(schema, schema, json).empty());
  CHECK(json["layers"] == 3);
  CHECK(json["agree"] == true);
  REQUIRE(json["pairs"].size() == 7 * 3);
  for (std::size_t i = 0; i < json["pairs"].size(); ++i) CHECK(json["pairs"][i]["layer"] == i % 3 + 1);
  for (const char* layer : {"", ".layer2", ".layer3"}) {
    for (const char* ending : {".exr", ".depth.png", ".id.png"})
      CHECK(fs::is_regular_file(folder / ("raster" + std::string(layer) + ending)));
  }
  CHECK(plumb::test::read_text((folder / "raster.layer2.exr").string()) ==
        plumb::test::read_text((folder / "bvh2.layer2.exr").string()));
  CHECK(plumb::test::read_text((folder / "raster.layer2.exr").string()) !=
        plumb::test::read_text((folder / "raster.exr").string()));
}

TEST_CASE("one layer is the comparison of frames, and tile has no more") {
  const std::string common = "compare builtin:grid:4 --size 16x9 --threads 1 --json ";
  const ToolRun one = run_tool(common + "--layers 1");
  REQUIRE(one.status == 0);
  const nlohmann::json json = nlohmann::json::parse(one.out);
  CHECK(json["layers"] == 1);
  CHECK(json["pairs"][0]["layer"] == 1);
  CHECK(json["runs"].size() - 1 == json["pairs"].size());
  const ToolRun two = run_tool(common + "--layers 2");
  REQUIRE(two.status == 0);
  for (const nlohmann::json& entry : nlohmann::json::parse(two.out)["runs"]) CHECK(entry["method"] != "tile");
  CHECK(run_tool(common + "--layers 2 --methods bvh8,tile").status == 2);
  CHECK(run_tool(common + "--layers 0").status == 2);
  CHECK(run_tool(common + "--layers 65").status == 2);
}

TEST_CASE("--visible lists the triangles that the frame shows") {
  const TempFolder folder;
  const std::string csv = (folder / "seen.csv").string();
  const std::string common =
      "render builtin:soup:500 --size 40x30 --method bvh8 --out " + (folder / "frame.exr").string();
  REQUIRE(run_tool(common + " --visible " + csv).status == 0);
  const plumb::BuiltinScene scene = plumb::builtin_scene("soup:500");
  plumb::Frame frame(40, 30);
  plumb::rasterize(scene.mesh, scene.camera(40, 30), frame);
  std::string expected = "id,pixels\n";
  for (const plumb::VisibleTriangle& seen : plumb::visible_triangles(frame))
    expected += std::to_string(seen.id) + "," + std::to_string(seen.pixels) + "\n";
  CHECK(plumb::test::read_text(csv) == expected);
  CHECK(run_tool(common + " --visible /no/such/folder/seen.csv").status == 2);
}
