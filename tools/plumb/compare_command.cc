#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "commands.h"
#include "encode.h"
#include "help.h"
#include "method.h"
#include "output_file.h"
#include "picture.h"
#include "plumb/error.h"
#include "plumb/ray.h"
#include "progress_bar.h"
#include "report.h"
#include "scene.h"
#include "verdict.h"

namespace plumb::tool {
namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  FrameOptions frame;
  std::optional<std::string> methods;  ///< without it the default ones
  int layers = 1;
  std::optional<std::string> out;  ///< without it no pictures
  bool json = false;
};

std::size_t count_seen(const Frame& frame) {
  return frame.id.size() - static_cast<std::size_t>(std::count(frame.id.begin(), frame.id.end(), kNone));
}

/// What stands for a layer, counted from 0, in the names of files: nothing for the first, which is the frame.
std::string layer_suffix(std::size_t layer) { return layer == 0 ? "" : fmt::format(".layer{}", layer + 1); }

/// The frame's files, by the run's name; adds their paths.
void write_pictures(const fs::path& folder, const std::string& name, const Frame& frame,
                    std::vector<std::string>& files) {
  const auto write = [&](const std::string& suffix, const std::vector<std::byte>& bytes) {
    files.push_back((folder / (name + suffix)).string());
    write_file(files.back(), bytes);
  };
  write(".exr", encode_exr(frame));
  write(".depth.png", encode_png(depth_picture(frame)));
  write(".id.png", encode_png(id_picture(frame)));
}

/// The picture of where the pair differs. Where it agrees there is none, nor stays one from an earlier
/// comparison into the same folder.
std::optional<std::string> write_difference(const fs::path& folder, const Pair& pair, const Frame& a,
                                            const Frame& b) {
  const std::string layer = pair.layer > 1 ? fmt::format(".layer{}", pair.layer) : "";
  const fs::path path = folder / fmt::format("{}-{}{}.diff.png", pair.a, pair.b, layer);
  if (pair.comparison.equal()) {
    std::error_code ignored;
    fs::remove(path, ignored);
    return std::nullopt;
  }
  write_file(path, encode_png(difference_picture(a, b)));
  return path.string();
}

std::size_t longest_name(const std::vector<Run>& runs) {
  std::size_t longest = 0;
  for (const Run& run : runs) longest = std::max(longest, run.name.size());
  return longest;
}

/// A run's frame and the layers behind it, from front to back.
std::vector<Frame> layers_of(RunResult&& result) {
  std::vector<Frame> layers = std::move(result.behind);
  layers.insert(layers.begin(), std::move(result.frame));
  return layers;
}

/// Compares a run's layers with the first run's, and says so on standard error.
void compare_layers(const std::string& name, const std::vector<Frame>& first,
                    const std::vector<Frame>& layers, const CompareOptions& options, CompareReport& report) {
  for (std::size_t i = 0; i < layers.size(); ++i) {
    Pair pair{report.runs.front().run.name, name, compare(first[i], layers[i]), std::nullopt,
              options.layers == 1 ? 0 : static_cast<int>(i) + 1};
    if (options.out) pair.picture = write_difference(*options.out, pair, first[i], layers[i]);
    fmt::print(stderr, "{}  {}\n{}", i == 0 ? "" : "   ", summary(pair), differences(pair));
    report.pairs.push_back(std::move(pair));
  }
}

/// Makes every run's frame, compares it with the first and says so on standard error. Holds two frames
/// at most.
CompareReport compare_runs(const std::vector<Run>& runs, const Scene& scene, const CompareOptions& options) {
  CompareReport report;
  report.layers = options.layers;
  std::vector<Frame> first;
  for (const Run& run : runs) {
    RunResult result =
        execute(run, scene.mesh, scene.camera, options.frame.threads, progress_bar, options.layers);
    report.runs.push_back(
        {run, result.build_seconds, result.frame_seconds, count_seen(result.frame), {}, result.choice});
    RunReport& entry = report.runs.back();
    fmt::print(stderr, "  {}", timing(entry, longest_name(runs)));
    std::vector<Frame> layers = layers_of(std::move(result));
    if (options.out) {
      for (std::size_t i = 0; i < layers.size(); ++i)
        write_pictures(*options.out, run.name + layer_suffix(i), layers[i], entry.files);
    }
    if (first.empty()) {
      first = std::move(layers);
      fmt::print(stderr, "\n");
      continue;
    }
    compare_layers(run.name, first, layers, options, report);
  }
  return report;
}

/// The methods to compare; of those that are compared unless said, the ones that make what is asked for.
std::vector<Method> methods_of(const CompareOptions& options) {
  std::vector<Method> methods = parse_methods(options.methods.value_or(default_methods()));
  if (options.layers == 1) return methods;
  if (!options.methods) std::erase_if(methods, [](Method method) { return !has_layers(method); });
  for (const Method method : methods) {
    if (!has_layers(method))
      throw Error(fmt::format("plumb: --methods {}: {} makes no layers; leave it out or --layers at 1",
                              *options.methods, method_name(method)));
  }
  return methods;
}

ExitStatus run_compare(const CompareOptions& options) {
  const std::vector<Run> runs = plan_runs(methods_of(options), options.frame.simd);
  if (options.out) make_folder(*options.out);
  const Scene scene = open_scene(options.frame);
  fmt::print(stderr, "{}\n", describe(scene));
  const CompareReport report = compare_runs(runs, scene, options);
  fmt::print(stderr, "{}\n", verdict(report));
  if (options.out) fmt::print(stderr, "pictures are in {}\n", *options.out);
  if (options.json) print_line(to_json(scene, options.frame.threads, report));
  return exit_status(report.pairs);
}

}  // namespace

void add_compare_command(CLI::App& app, int& status) {
  CLI::App* command =
      app.add_subcommand("compare", "Make one frame by several methods and compare every pixel");
  const auto options = std::make_shared<CompareOptions>();
  add_scene_option(*command, options->frame.scene);
  add_frame_options(*command, options->frame);
  command
      ->add_option("--methods", options->methods, "what to compare; the first is what the others must equal")
      ->type_name("LIST")
      ->default_str(default_methods());
  command
      ->add_option("--layers", options->layers,
                   "compare the first K surfaces of every pixel, layer by layer (not by tile)")
      ->type_name("K")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  command->add_option("--out", options->out, "write each frame and its pictures into this folder")
      ->type_name("DIR");
  command->add_flag("--json", options->json, "print the results as JSON on standard output");
  command->footer(compare_help());
  command->callback([options, &status] { status = run_compare(*options); });
}

}  // namespace plumb::tool
