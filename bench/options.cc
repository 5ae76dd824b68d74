#include "options.h"

#include <algorithm>
#include <charconv>
#include <string_view>
#include <thread>
#include <utility>

#include "plumb/builtin.h"
#include "plumb/error.h"

namespace plumb::bench {

const char* const kUsage =
    R"(plumb_bench [SCENE...] [--table] [options] [--benchmark_...]

Builds, camera, shadow and diffuse rays and frames, by every method, tree width and instruction set, with
Embree and llvmpipe beside them where they are installed. Exact methods' answers must be the binary BVH's, bit for bit,
before a time counts; those of the fast and the watertight arithmetic and of Embree are counted.

  SCENE            builtin:NAME[:SIZE], a mesh FILE, or FILE@VIEW; unless said, the built-in scenes
  --cameras=LIST   the views of mesh files, a line each: scene view eye target up fov_y_degrees
  --table          tables in Markdown, all methods interleaved, instead of Google Benchmark's list
  --peers          the same, against the fastest of all of Embree's calls and trees
  --methods=LIST   only these methods, with commas: raster,auto,llvmpipe,bvh8,bvh8-single,bvh8-best-build,embree-fast-16
  --works=LIST     only these: camera,shadow,occlusion,diffuse,random,frame,build
  --rounds=N       how often the table runs each method; it shows medians (5)
  --threads=LIST   counts or "all", with commas (1,all)
  --simd=LIST      instruction sets, with commas, "auto" for the best, or "all" (all)
  --peer-isa=ISA   the most that Embree may use: sse4.2, avx, avx2 (all that the machine has)
  --size=WxH       pixels of a frame (1280x720)
)";

namespace {

int parse_count(std::string_view text, const std::string& argument) {
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || stop != text.data() + text.size() || value < 1) {
    throw Error("plumb_bench: '" + argument + "': '" + std::string(text) + "' is no number above 0");
  }
  return value;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + 1);
  }
}

std::vector<int> parse_threads(std::string_view list, const std::string& argument) {
  std::vector<int> counts;
  for (const std::string_view part : split(list, ',')) {
    const int all = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    const int count = part == "all" ? all : parse_count(part, argument);
    // On a machine with one thread "1,all" is one count, not two.
    if (std::find(counts.begin(), counts.end(), count) == counts.end()) counts.push_back(count);
  }
  return counts;
}

std::vector<Simd> parse_targets(std::string_view list) {
  if (list == "all") return simd_targets();
  if (list == "auto") return {simd_targets().front()};
  std::vector<Simd> targets;
  for (const std::string_view part : split(list, ',')) targets.push_back(parse_simd(part));
  return targets;
}

void parse_size(std::string_view text, const std::string& argument, Options& options) {
  const std::vector<std::string_view> sides = split(text, 'x');
  if (sides.size() != 2) throw Error("plumb_bench: '" + argument + "': give a size as WIDTHxHEIGHT");
  options.width = parse_count(sides[0], argument);
  options.height = parse_count(sides[1], argument);
}

}  // namespace

Options parse_options(int argc, const char* const* argv) {
  Options options;
  options.threads = parse_threads("1,all", "--threads");
  options.targets = simd_targets();
  std::string cameras;
  std::vector<std::string> scenes;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    const std::size_t equals = argument.find('=');
    const std::string key = argument.substr(0, equals);
    const std::string value = equals == std::string::npos ? "" : argument.substr(equals + 1);
    if (key == "--help" || key == "-h") {
      options.help = true;
    } else if (key == "--table") {
      options.table = true;
    } else if (key == "--peers") {
      options.table = options.peers = true;
    } else if (key == "--methods") {
      for (const std::string_view part : split(value, ',')) options.methods.emplace_back(part);
    } else if (key == "--works") {
      for (const std::string_view part : split(value, ',')) options.works.emplace_back(part);
    } else if (key == "--cameras") {
      cameras = value;
    } else if (key == "--rounds") {
      options.rounds = parse_count(value, argument);
    } else if (key == "--threads") {
      options.threads = parse_threads(value, argument);
    } else if (key == "--simd") {
      options.targets = parse_targets(value);
    } else if (key == "--peer-isa") {
      options.peer_isa = value;
    } else if (key == "--size") {
      parse_size(value, argument, options);
    } else if (argument.rfind("-", 0) == 0) {
      throw Error("plumb_bench: unknown option '" + argument + "'; --help lists them");
    } else {
      scenes.push_back(argument);
    }
  }
  if (scenes.empty()) {
    for (const BuiltinInfo& info : builtin_scenes()) scenes.push_back("builtin:" + info.name);
  }
  for (const std::string& scene : scenes) {
    for (ViewName& view : views_of(scene, cameras)) options.views.push_back(std::move(view));
  }
  return options;
}

}  // namespace plumb::bench
