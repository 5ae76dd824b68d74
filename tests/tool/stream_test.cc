#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <doctest/doctest.h>

#include "mesh_files.h"
#include "plumb/builtin.h"
#include "plumb/mesh.h"
#include "ply_util.h"
#include "tool/run_tool.h"

// plumb render --stream.

namespace fs = std::filesystem;
using plumb::TriangleMesh;
using plumb::test::read_text;
using plumb::test::run_tool;
using plumb::test::TempFolder;
using plumb::test::ToolRun;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string write(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
  return path.string();
}

// With a triangle that is never seen, far from all others.
const TriangleMesh& mesh() {
  static const TriangleMesh kMesh = [] {
    TriangleMesh mesh = plumb::builtin_scene("teapot-in-stadium:30000").mesh;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{1e9f, 0, 0}, {0, 1e9f, 0}});
    mesh.positions.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f);
    mesh.triangles.emplace_back(first, first + 1, first + 2);
    return mesh;
  }();
  return kMesh;
}

TriangleMesh piece(std::size_t begin, std::size_t end) {
  TriangleMesh result{mesh().positions, {}};
  const auto at = [](std::size_t i) { return mesh().triangles.begin() + static_cast<std::ptrdiff_t>(i); };
  result.triangles.assign(at(begin), at(end));
  return result;
}

}  // namespace

TEST_SUITE_BEGIN("tool: streams");

TEST_CASE("render --stream writes the file that render writes, from one file or several, in many parts") {
  const TempFolder folder;
  const std::string whole = write(folder / "whole.obj", plumb::test::make_obj(mesh()));
  const std::size_t count = mesh().triangles.size();
  const std::string files =
      write(folder / "a.stl", plumb::test::make_stl_binary(piece(0, count / 3))) + " " +
      write(folder / "b.off", plumb::test::make_off(piece(count / 3, count / 3))) + " " +
      write(folder / "c.ply",
            plumb::test::make_ply_of(piece(count / 3, count), plumb::test::kPlyFormats.at(1)));
  const std::string out = (folder / "out.exr").string();
  for (const std::string camera :
       {"", "--up 0,0,1 --fov 20", "--eye 0,30,90", "--eye 0,30,90 --target 1,2,3", "--target 1,2,3"}) {
    CAPTURE(camera);
    const std::string seen = (folder / "seen.csv").string();
    const std::string frame = " --size 90x60 --threads 1 --out " + out + " --visible " + seen + " " + camera;
    REQUIRE(run_tool("render " + whole + " --method bvh8" + frame).status == 0);
    const std::string expected = read_text(out), expected_seen = read_text(seen);
    for (const std::string& run :
         {"render --stream " + whole, "render " + whole + " --stream --memory 1 --method raster",
          "render --memory 1 " + files + " --stream"}) {
      CAPTURE(run);
      fs::remove(out);
      fs::remove(seen);
      const ToolRun streamed = run_tool(run + frame);
      CAPTURE(streamed.err);
      CHECK(streamed.status == 0);
      CHECK(streamed.out.empty());
      CHECK(has(streamed.err, std::to_string(count) + " triangles"));
      CHECK(read_text(out) == expected);
      CHECK(read_text(seen) == expected_seen);
    }
  }
}

TEST_CASE("a file that is at fault half way is named, and nothing is written") {
  const TempFolder folder;
  const std::string good = write(folder / "good.off", plumb::test::make_off(mesh()));
  const std::string bad = write(folder / "bad.obj", plumb::test::make_obj(mesh()) + "f 1 2 no\n");
  const fs::path out = folder / "out" / "frame.exr";
  fs::create_directory(folder / "out");
  for (const std::string camera : {"", "--eye 0,30,90 --target 0,0,0"}) {
    const ToolRun run = run_tool("render --stream --memory 1 " + good + " " + bad + " --size 9x9 --out " +
                                 out.string() + " " + camera);
    CAPTURE(run.err);
    CHECK(run.status == 2);
    CHECK(has(run.err, bad + ": line "));
    CHECK(has(run.err, "found \"no\""));
    CHECK(fs::is_empty(folder / "out"));
  }
}

TEST_CASE("what cannot be streamed is refused before any work") {
  const TempFolder folder;
  const std::string file = write(folder / "a.off", plumb::test::make_off(mesh()));
  const std::string out = " --out " + (folder / "frame.exr").string();
  struct Case {
    std::string arguments, named;
  };
  const std::vector<Case> cases = {
      {"--stream", "name the mesh files"},
      {"--stream builtin:grid:2", "builtin:grid:2"},
      {"--stream " + file + " builtin:grid:2", "builtin:grid:2"},
      {"--stream " + file + " /nowhere/b.ply", "/nowhere/b.ply: No such file"},
      {"--stream " + file + " /dev/null", "/dev/null: is not a regular file"},
      {"--stream --method bvh8 " + file, "--method bvh8: only raster"},
      {"--stream --method nonesuch " + file, "nonesuch"},
      {"--stream --memory 0 " + file, "--memory 0"},
      {"--stream --memory -5 " + file, "-5"},
      {"--stream --memory much " + file, "much"},
      {"--stream --memory 9999999 " + file, "--memory 9999999"},
      {"--stream --threads -1 " + file, "--threads -1"},
      {"--stream --simd all " + file, "--simd all"},
      {"--memory 64 --method raster " + file, "--memory"},
      {file, "--method"},
      {"--method raster " + file + " b.ply", "'b.ply'"},
  };
  for (const Case& c : cases) {
    const ToolRun run = run_tool("render " + c.arguments + out);
    CAPTURE(c.arguments);
    CAPTURE(run.err);
    CHECK(run.status == 2);
    CHECK(run.out.empty());
    CHECK(has(run.err, c.named));
    CHECK(!fs::exists(folder / "frame.exr"));
  }
}

TEST_SUITE_END();
