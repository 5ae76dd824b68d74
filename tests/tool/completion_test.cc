#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <doctest/doctest.h>
#include <CLI/CLI.hpp>

#include "cases/cases.h"
#include "commands.h"
#include "method.h"
#include "plumb/builtin.h"
#include "plumb/simd.h"
#include "tool/run_tool.h"

// The completion for bash against what the tool really takes.

namespace fs = std::filesystem;
using plumb::test::TempFolder;

namespace {

using Words = std::vector<std::string>;

// What is offered at the end of the line, sorted; the options that it sets begin with "-o ".
Words complete(const std::string& line) {
  const TempFolder folder;
  const std::string out = (folder / "out").string();
  const std::string command = "bash '" PLUMB_TESTS_DIR "/tool/complete.bash' '" PLUMB_COMPLETION
                              "' '" PLUMB_TOOL "' '" +
                              line + "' > '" + out + "' 2>&1";
  CHECK(std::system(command.c_str()) == 0);
  std::istringstream text(plumb::test::read_text(out));
  Words words;
  for (std::string word; std::getline(text, word);) words.push_back(word);
  std::sort(words.begin(), words.end());
  return words;
}

Words sorted(Words words) {
  std::sort(words.begin(), words.end());
  return words;
}

struct Commands {
  Commands() {
    plumb::tool::add_compare_command(app, status);
    plumb::tool::add_render_command(app, status);
    plumb::tool::add_info_command(app, status);
    plumb::tool::add_soak_command(app, status);
    plumb::tool::add_report_command(app, status);
  }
  CLI::App app;
  int status = 0;
};

Words long_options(const CLI::App& command) {
  Words names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return sorted(names);
}

Words methods() {
  Words names;
  for (const plumb::tool::MethodInfo& info : plumb::tool::all_methods()) names.emplace_back(info.name);
  return sorted(names);
}

Words instruction_sets(const Words& more) {
  Words names = more;
  for (const plumb::Simd simd : plumb::simd_targets()) names.emplace_back(plumb::simd_name(simd));
  return sorted(names);
}

}  // namespace

TEST_SUITE_BEGIN("tool: completion");

TEST_CASE("every subcommand and every one of its options is offered") {
  const Commands commands;
  Words names;
  for (const CLI::App* command : commands.app.get_subcommands({})) {
    CAPTURE(command->get_name());
    names.push_back(command->get_name());
    CHECK(complete("plumb " + command->get_name() + " --") == long_options(*command));
  }
  CHECK(names.size() == 5);
  CHECK(complete("plumb ") == sorted(names));
  CHECK(complete("plumb re") == Words{"render", "report"});
  CHECK(complete("plumb --") == Words{"--help", "--version"});
  CHECK(complete("plumb nonesuch --").empty());
}

TEST_CASE("built-in scenes are offered behind the colon, where bash begins a word") {
  Words names;
  for (const plumb::BuiltinInfo& scene : plumb::builtin_scenes()) names.push_back(scene.name);
  CHECK(complete("plumb compare builtin:") == sorted(names));
  CHECK(complete("plumb info --json builtin:terr") == Words{"terrain"});
  CHECK(complete("plumb info builtin:nonesuch").empty());
  CHECK(complete("plumb report mesh.ply builtin:grid builtin:terr") == Words{"terrain"});
  CHECK(complete("plumb render --stream mesh.ply builtin:terr") == Words{"terrain"});
}

TEST_CASE("methods, instruction sets, cases and widths are offered as values, a list's each once") {
  CHECK(complete("plumb render --method ") == methods());
  CHECK(complete("plumb render --method=bvh") == Words{"bvh2", "bvh4", "bvh8"});
  CHECK(complete("plumb compare --methods bvh2,ra") == Words{"-o nospace", "bvh2,raster"});
  CHECK(complete("plumb compare --methods=raster,bvh4,bvh") ==
        Words{"-o nospace", "raster,bvh4,bvh2", "raster,bvh4,bvh8"});
  CHECK(complete("plumb compare --simd ") == instruction_sets({"auto", "all"}));
  CHECK(complete("plumb render --simd=") == instruction_sets({"auto"}));
  CHECK(complete("plumb info --width ") == Words{"2", "4", "8"});
  Words cases;
  for (const plumb::cases::Case& hard_case : plumb::cases::all_cases()) cases.emplace_back(hard_case.name);
  cases.emplace_back("-o nospace");
  CHECK(complete("plumb report --cases ") == sorted(cases));
  CHECK(complete("plumb compare --size 19") == Words{"1920x1080"});
  CHECK(complete("plumb soak --seconds ").empty());
}

TEST_CASE("files are offered by what a subcommand reads and writes, and folders on the way") {
  const TempFolder folder;
  const std::string at = folder.path().string() + "/";
  for (const std::string name :
       {"a.ply", "b.OBJ", "c.stl", "d.off", "e.txt", "f.exr", "g.md", "two words.ply"}) {
    std::ofstream(folder / name) << "x";
  }
  fs::create_directory(folder / "sub");
  const Words meshes = {"-o filenames", at + "a.ply", at + "b.OBJ",        at + "c.stl",
                        at + "d.off",   at + "sub",   at + "two words.ply"};
  CHECK(complete("plumb compare " + at) == meshes);
  CHECK(complete("plumb info --threads 2 " + at) == meshes);
  CHECK(complete("plumb info --threads=2 " + at) == meshes);
  CHECK(complete("plumb render --stream " + at) == meshes);
  CHECK(complete("plumb render --memory 64 --stream " + at + "a.ply " + at) == meshes);
  CHECK(complete("plumb render --method raster --out " + at) ==
        Words{"-o filenames", at + "f.exr", at + "sub"});
  CHECK(complete("plumb report --out=" + at + "g") == Words{"-o filenames", at + "g.md"});
  CHECK(complete("plumb compare --out " + at) == Words{"-o filenames", at + "sub"});
}

TEST_CASE("behind a SCENE, and where there is none, only options are left") {
  const Commands commands;
  const Words info = long_options(*commands.app.get_subcommand("info"));
  CHECK(complete("plumb info mesh.ply ") == info);
  CHECK(complete("plumb info builtin:grid:2 --json ") == info);
  CHECK(complete("plumb soak ") == long_options(*commands.app.get_subcommand("soak")));
}

TEST_SUITE_END();
