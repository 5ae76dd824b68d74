#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "encode.h"
#include "help.h"
#include "method.h"
#include "output_file.h"
#include "plumb/error.h"
#include "progress_bar.h"
#include "report.h"
#include "scene.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  FrameOptions frame;
  std::string method, out;
};

Run the_only_run(const RenderOptions& options) {
  const std::vector<Run> runs = plan_runs({parse_method(options.method)}, options.frame.simd);
  if (runs.size() != 1) {
    throw Error(fmt::format("plumb: --simd {}: render makes one frame; name one target", options.frame.simd));
  }
  return runs.front();
}

/// Before the work: what will surely go wrong after it.
void check_out(const fs::path& out) {
  if (out.extension() != ".exr") {
    throw Error(fmt::format("plumb: --out {}: render writes OpenEXR; end the name in .exr", out.string()));
  }
  const fs::path folder = out.has_parent_path() ? out.parent_path() : fs::path(".");
  std::error_code unreadable;
  if (!fs::is_directory(folder, unreadable)) {
    throw Error(fmt::format("plumb: --out {}: there is no folder {}", out.string(), folder.string()));
  }
}

ExitStatus run_render(const RenderOptions& options) {
  const Run run = the_only_run(options);
  check_out(options.out);
  const Scene scene = open_scene(options.frame);
  fmt::print(stderr, "{}\n", describe(scene));
  const RunResult result = execute(run, scene.mesh, scene.camera, options.frame.threads, progress_bar);
  write_file(options.out, encode_exr(result.frame));
  fmt::print(stderr, "  {}\nwrote {}\n",
             timing({run, result.build_seconds, result.frame_seconds, 0, {}, result.choice}, 0), options.out);
  return kAgree;
}

}  // namespace

void add_render_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("render", "Make one frame by one method and write it as OpenEXR");
  const auto options = std::make_shared<RenderOptions>();
  add_frame_options(*command, options->frame);
  command->get_option("--simd")->description("instruction set: auto (the best) or a name");
  command->add_option("--method", options->method, "how to make it")->type_name("NAME")->required();
  command->add_option("--out", options->out, "the file to write")->type_name("FILE.exr")->required();
  command->footer(render_help());
  command->callback([options, &status] { status = run_render(*options); });
}

}  // namespace plumb::tool
