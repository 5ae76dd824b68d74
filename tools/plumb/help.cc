#include "help.h"

#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "method.h"
#include "plumb/builtin.h"
#include "plumb/simd.h"

namespace plumb::tool {
namespace {

std::string scenes_help() {
  std::string text = "Built-in scenes, as builtin:NAME[:SIZE]:\n";
  for (const BuiltinInfo& scene : builtin_scenes()) {
    fmt::format_to(std::back_inserter(text), "  {}: {}\n      SIZE: {}; {} unless said\n", scene.name,
                   scene.description, scene.size_meaning, scene.default_size);
  }
  return text;
}

std::string methods_help() {
  std::string text = "Methods:\n";
  for (const MethodInfo& info : all_methods()) {
    fmt::format_to(std::back_inserter(text), "  {:<8}{}\n", info.name, info.description);
  }
  text += "Instruction sets of this machine, best first (the scalar methods have none):\n ";
  for (const Simd simd : simd_targets()) text.append(" ").append(simd_name(simd));
  return text + "\n";
}

constexpr std::string_view kCameraHelp =
    "The camera is the built-in scene's own, or frames all of a file's mesh; each of --eye, --target, --up\n"
    "and --fov that is given replaces that part of it.\n";

}  // namespace

std::string compare_help() {
  return fmt::format(
      "\n{}\n{}\n{}\n"
      "--out writes METHOD.exr (channels Z, float, and id, uint), METHOD.depth.png and METHOD.id.png, and\n"
      "A-B.diff.png where two differ; with several instruction sets METHOD is METHOD-NAME.\n\n"
      "Exit status: 0 the methods agree in every pixel, 1 they do not, 2 bad usage or input.\n",
      scenes_help(), methods_help(), kCameraHelp);
}

std::string render_help() {
  return fmt::format(
      "\n{}\n{}\n{}\n"
      "FILE.exr has the channels Z (float: the depth, +inf where nothing is seen) and id (uint: the\n"
      "triangle, 4294967295 where nothing is seen).\n\n"
      "Exit status: 0 the frame is written, 2 bad usage or input.\n",
      scenes_help(), methods_help(), kCameraHelp);
}

std::string info_help() {
  return fmt::format(
      "\n{}\n"
      "Vertices at equal positions count as one. The surface is closed where every edge belongs to an even\n"
      "number of triangles, manifold where it is a disk or half a disk about every point, oriented where\n"
      "neighbours agree which side is the front.\n\n"
      "Exit status: 0, or 2 for bad usage or input.\n",
      scenes_help());
}

}  // namespace plumb::tool
