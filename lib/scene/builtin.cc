#include "plumb/builtin.h"

#include <charconv>
#include <string>
#include <system_error>

#include "base/fp_mode.h"
#include "plumb/error.h"
#include "scene/builtin_scenes.h"

namespace plumb {
namespace {

struct Entry {
  const char* name;
  const char* description;
  std::size_t default_size, least, greatest;
  const char* size_meaning;
  BuiltinScene (*make)(std::size_t size);
};

constexpr Entry kEntries[] = {
    {"teapot-in-stadium", "the Utah teapot on a plinth at the centre of a stadium a thousand times its size",
     detail::kTeapotInStadiumSize, 2'000, 10'000'000, "triangles, about", detail::teapot_in_stadium},
    {"terrain", "fractal mountains, a height field seen at a grazing angle", 500'000, 2, 150'000'000,
     "triangles, about", detail::terrain},
    {"grid",
     "a relief of blocks on integer coordinates; in frames of 720, 1080 or 512 lines, or half as many, "
     "pixel rays meet its vertices and edges exactly",
     384, 1, 4096, "blocks in a row of the upper half", detail::grid},
    {"grass", "a meadow of thin bent blades, seen from just above them", 500'000, 7, 50'000'000,
     "triangles, about", detail::grass},
    {"soup", "triangles of no order strewn through a cube, smaller the more there are", 200'000, 1,
     150'000'000, "triangles", detail::soup},
    {"spheres", "a cloud of spheres of very different sizes, each of them closed", 500'000, 8, 150'000'000,
     "triangles, about", detail::spheres},
    {"quads", "layers that each fill the whole view, the farthest first", 256, 1, 1'000'000, "layers",
     detail::quads},
    {"cornell", "the Cornell box, whose lamp lies in the plane of the ceiling", 32, 32, 50'000'000,
     "triangles, about", detail::cornell},
    {"ties", "stacks of triangles at equal and nearly equal depths, in shuffled order", 100'000, 64,
     10'000'000, "triangles, about", detail::ties},
};

const Entry& find_entry(std::string_view name) {
  for (const Entry& entry : kEntries) {
    if (name == entry.name) return entry;
  }
  std::string message = "plumb: no built-in scene is called '" + std::string(name) + "'; there are:";
  const char* separator = " ";
  for (const Entry& entry : kEntries) {
    message.append(separator).append(entry.name);
    separator = ", ";
  }
  throw Error(message);
}

std::size_t parse_size(const Entry& entry, std::string_view text) {
  std::size_t size = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, size);
  const bool is_number = error == std::errc() && stop == end;
  if (is_number && size >= entry.least && size <= entry.greatest) return size;
  throw Error("plumb: '" + std::string(text) + "' is no size for the built-in scene '" + entry.name +
              "'; give a whole number from " + std::to_string(entry.least) + " to " +
              std::to_string(entry.greatest) + " (" + entry.size_meaning + ")");
}

[[gnu::noinline]] BuiltinScene make_scene(const Entry& entry, std::size_t size) { return entry.make(size); }

}  // namespace

std::vector<BuiltinInfo> builtin_scenes() {
  std::vector<BuiltinInfo> scenes;
  for (const Entry& entry : kEntries) {
    scenes.push_back({entry.name, entry.description, entry.default_size,
                      std::string(entry.size_meaning) + ", from " + std::to_string(entry.least) + " to " +
                          std::to_string(entry.greatest)});
  }
  return scenes;
}

BuiltinScene builtin_scene(std::string_view name_and_size) {
  const std::size_t colon = name_and_size.find(':');
  const Entry& entry = find_entry(name_and_size.substr(0, colon));
  const std::size_t size = colon == std::string_view::npos
                               ? entry.default_size
                               : parse_size(entry, name_and_size.substr(colon + 1));
  return detail::with_default_fp_mode([&] { return make_scene(entry, size); });
}

}  // namespace plumb
