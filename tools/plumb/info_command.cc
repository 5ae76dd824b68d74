#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "help.h"
#include "info.h"
#include "method.h"
#include "output_file.h"
#include "plumb/advise.h"
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
  int width = 0;        ///< 0: each of 2, 4 and 8
  std::string methods;  ///< instead, where it is not empty
  int threads = 0;
  bool json = false;
};

std::vector<Method> chosen_methods(const InfoOptions& options) {
  if (!options.methods.empty()) {
    if (options.width != 0) throw Error("plumb: --width and --methods both say which trees: give one");
    return parse_methods(options.methods);
  }
  if (options.width == 0) return {Method::Bvh2, Method::Bvh4, Method::Bvh8};
  if (options.width != 2 && options.width != 4 && options.width != 8)
    throw Error(fmt::format("plumb: --width {}: give 2, 4 or 8", options.width));
  return {parse_method(fmt::format("bvh{}", options.width))};
}

Info look_at(const InfoOptions& options) {
  const std::vector<Method> methods = chosen_methods(options);
  FrameOptions frame;
  frame.scene = options.scene;
  const Scene scene = open_scene(frame);
  const TriangleMesh& mesh = scene.mesh;
  Info info{options.scene, mesh.positions.size(), mesh.triangles.size(), box_of(mesh), {}, {}, {},
            advise(mesh)};
  info.raster = count_raster_tests(mesh, scene.camera);
  info.topology = topology(mesh, progress_bar("topology"));
  for (const Method method : methods) {
    const std::string name(method_name(method));
    const Structure tree =
        build_method(method, mesh, Simd::Auto, options.threads, progress_bar(name + ": build"));
    info.trees.push_back({name, tree.statistics()});
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
  command->add_option("--methods", options->methods, "the trees and other structures of these methods")
      ->type_name("LIST");
  add_threads_option(*command, options->threads);
  command->add_flag("--json", options->json, "print it as JSON");
  command->footer(info_help());
  command->callback([options, &status] { status = run_info(*options); });
}

}  // namespace plumb::tool
