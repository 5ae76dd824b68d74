#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "help.h"
#include "info.h"
#include "output_file.h"
#include "plumb/bvh.h"
#include "plumb/error.h"
#include "plumb/topology.h"
#include "progress_bar.h"
#include "scene.h"
#include "text.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

struct InfoOptions {
  std::string scene = kDefaultScene;
  int width = 0;  ///< 0: each of kWidths
  int threads = 0;
  bool json = false;
};

const std::vector<int> kWidths = {2, 4, 8};

std::vector<int> chosen_widths(int width) {
  if (width == 0) return kWidths;
  if (std::find(kWidths.begin(), kWidths.end(), width) != kWidths.end()) return {width};
  throw Error(fmt::format("plumb: --width {}: give 2, 4 or 8", width));
}

Info look_at(const InfoOptions& options) {
  const std::vector<int> widths = chosen_widths(options.width);
  const TriangleMesh mesh = open_mesh(options.scene);
  Info info{options.scene, mesh.positions.size(), mesh.triangles.size(), box_of(mesh), {}, {}};
  info.topology = topology(mesh, progress_bar("topology"));
  for (const int width : widths) {
    BuildOptions build;
    build.width = width;
    build.threads = options.threads;
    build.progress = progress_bar(fmt::format("bvh{}: build", width));
    info.trees.push_back(Bvh(mesh, build).statistics());
  }
  return info;
}

ExitStatus run_info(const InfoOptions& options) {
  check_threads(options.threads);
  const Info info = look_at(options);
  print_line(options.json ? to_json(info) : to_text(info));
  return kAgree;
}

}  // namespace

void add_info_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("info", "Say what a mesh and its trees are like");
  const auto options = std::make_shared<InfoOptions>();
  add_scene_option(*command, options->scene);
  command->add_option("--width", options->width, "only the tree of so many children a node")
      ->type_name("2|4|8");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print it as JSON");
  command->footer(info_help());
  command->callback([options, &status] { status = run_info(*options); });
}

}  // namespace plumb::tool
