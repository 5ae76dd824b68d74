#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
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
#include "plumb/stream.h"
#include "plumb/visible_triangles.h"
#include "progress_bar.h"
#include "report.h"
#include "scene.h"
#include "stream_scene.h"
#include "text.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMiB = std::size_t{1} << 20;
constexpr std::int64_t kMostMemoryMib = 1 << 20;

struct RenderOptions {
  FrameOptions frame;
  std::vector<std::string> scenes;  ///< several of a stream only
  std::string method, out;
  bool stream = false;
  std::optional<std::int64_t> memory_mib;
  std::optional<std::string> visible;  ///< where the list of visible triangles goes
};

Run the_only_run(const RenderOptions& options, Method method) {
  const std::vector<Run> runs = plan_runs({method}, options.frame.simd);
  if (runs.size() != 1) {
    throw Error(fmt::format("plumb: --simd {}: render makes one frame; name one target", options.frame.simd));
  }
  return runs.front();
}

/// The folder of a file to write must be there.
void check_folder(const std::string& option, const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code unreadable;
  if (!fs::is_directory(folder, unreadable)) {
    throw Error(fmt::format("plumb: {} {}: there is no folder {}", option, file.string(), folder.string()));
  }
}

/// The triangles that the frame shows as comma-separated values, a line each, by id.
std::string visible_csv(const Frame& frame) {
  std::string text = "id,pixels\n";
  for (const VisibleTriangle& triangle : visible_triangles(frame))
    fmt::format_to(std::back_inserter(text), "{},{}\n", triangle.id, triangle.pixels);
  return text;
}

void write_visible(const std::string& file, const Frame& frame) {
  const std::string csv = visible_csv(frame);
  write_file(file, std::as_bytes(std::span(csv)));
}

/// Before the work: what will surely go wrong after it.
void check_out(const fs::path& out) {
  if (out.extension() != ".exr") {
    throw Error(fmt::format("plumb: --out {}: render writes OpenEXR; end the name in .exr", out.string()));
  }
  check_folder("--out", out);
}

std::size_t stream_memory(const RenderOptions& options) {
  if (!options.memory_mib) return StreamOptions().memory_bytes;
  if (*options.memory_mib < 1 || *options.memory_mib > kMostMemoryMib) {
    throw Error(fmt::format("plumb: --memory {}: give 1 to {} MiB", *options.memory_mib, kMostMemoryMib));
  }
  return static_cast<std::size_t>(*options.memory_mib) * kMiB;
}

ExitStatus render_stream(const RenderOptions& options) {
  if (!options.method.empty() && parse_method(options.method) != Method::Raster) {
    throw Error(fmt::format("plumb: --method {}: only raster draws a --stream", options.method));
  }
  const std::size_t memory_bytes = stream_memory(options);
  check_threads(options.frame.threads);
  const Run run = the_only_run(options, Method::Raster);
  check_out(options.out);
  if (options.visible) check_folder("--visible", *options.visible);
  const StreamScene scene(options.scenes, memory_bytes);
  const Camera camera = stream_camera(options.frame, scene, progress_bar);
  fmt::print(stderr, "{}; {}x{} pixels from ({}, {}, {})\n", scene.name(), camera.width, camera.height,
             camera.eye.x, camera.eye.y, camera.eye.z);
  const StreamFrame result = draw_stream(scene, camera, run, options.frame.threads, progress_bar);
  write_file(options.out, encode_exr(result.frame));
  if (options.visible) write_visible(*options.visible, result.frame);
  fmt::print(stderr, "  {}  {} triangles, {} vertices in {} part{}  {:.1f} s\nwrote {}\n", run.name,
             result.totals.triangles, result.totals.vertices, result.totals.parts,
             result.totals.parts == 1 ? "" : "s", result.seconds, options.out);
  if (options.visible) fmt::print(stderr, "wrote {}\n", *options.visible);
  return kAgree;
}

ExitStatus run_render(RenderOptions options) {
  if (options.stream) return render_stream(options);
  if (options.method.empty()) throw Error("plumb: render: --method is missing: name one that --help lists");
  if (options.memory_mib) throw Error("plumb: --memory: only a --stream is read in parts");
  if (options.scenes.size() > 1) {
    throw Error(
        fmt::format("plumb: render: one SCENE too many: '{}'; with --stream several files are one scene",
                    options.scenes[1]));
  }
  if (!options.scenes.empty()) options.frame.scene = options.scenes.front();
  const Run run = the_only_run(options, parse_method(options.method));
  check_out(options.out);
  if (options.visible) check_folder("--visible", *options.visible);
  const Scene scene = open_scene(options.frame);
  fmt::print(stderr, "{}\n", describe(scene));
  const RunResult result = execute(run, scene.mesh, scene.camera, options.frame.threads, progress_bar);
  write_file(options.out, encode_exr(result.frame));
  if (options.visible) write_visible(*options.visible, result.frame);
  fmt::print(stderr, "  {}\nwrote {}\n",
             timing({run, result.build_seconds, result.frame_seconds, 0, {}, result.choice}, 0), options.out);
  if (options.visible) fmt::print(stderr, "wrote {}\n", *options.visible);
  return kAgree;
}

}  // namespace

void add_render_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("render", "Make one frame by one method and write it as OpenEXR");
  const auto options = std::make_shared<RenderOptions>();
  command->add_option(
      "SCENE", options->scenes,
      fmt::format("a mesh file (PLY, OBJ, STL, OFF), or builtin:NAME[:SIZE]; {} unless said; with "
                  "--stream one file or several",
                  kDefaultScene));
  add_frame_options(*command, options->frame);
  command->get_option("--simd")->description("instruction set: auto (the best) or a name");
  command
      ->add_option("--method", options->method,
                   "how to make it; of a --stream only raster, which need not be said")
      ->type_name("NAME");
  command->add_flag("--stream", options->stream,
                    "read the files in parts and draw these as they come: for scenes larger than memory");
  command->add_option("--memory", options->memory_mib, "--stream: what reading may hold; 64 unless said")
      ->type_name("MIB");
  command->add_option("--out", options->out, "the file to write")->type_name("FILE.exr")->required();
  command
      ->add_option("--visible", options->visible,
                   "also write the triangles that the frame shows, each with its pixels")
      ->type_name("FILE.csv");
  command->footer(render_help());
  command->callback([options, &status] { status = run_render(*options); });
}

}  // namespace plumb::tool
