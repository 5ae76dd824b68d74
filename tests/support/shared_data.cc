#include "support/shared_data.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace plumb::shared {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "the shared files are little-endian");

fs::path root() { return PLUMB_SHARED_DIR; }

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

std::string read_file(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, "cannot be opened");
  return {std::istreambuf_iterator<char>(in), {}};
}

// A file that is an array of T.
template <typename T>
std::vector<T> read_array(const fs::path& path) {
  const std::string bytes = read_file(path);
  if (bytes.size() % sizeof(T) != 0) fail(path, "its size is no multiple of a record's");
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

// Takes what it reads from the front of a file's bytes.
class Reader {
 public:
  Reader(fs::path path, std::string_view bytes) : path_(std::move(path)), bytes_(bytes) {}

  std::string_view take(std::size_t size) {
    if (size > bytes_.size()) fail(path_, "ends too early");
    const std::string_view taken = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return taken;
  }

  void expect(std::string_view text) {
    if (take(text.size()) != text) fail(path_, "lacks '" + std::string(text) + "' where it belongs");
  }

  template <typename T>
  T value() {
    T result;
    std::memcpy(&result, take(sizeof(T)).data(), sizeof(T));
    return result;
  }

  std::size_t number() {
    std::size_t result = 0;
    const auto [end, error] = std::from_chars(bytes_.data(), bytes_.data() + bytes_.size(), result);
    if (error != std::errc()) fail(path_, "lacks a number where it belongs");
    bytes_.remove_prefix(static_cast<std::size_t>(end - bytes_.data()));
    return result;
  }

  bool at_end() const { return bytes_.empty(); }

 private:
  fs::path path_;
  std::string_view bytes_;
};

// The number that a word spells, rounded once.
template <typename T>
T parse(const fs::path& path, const std::string& word) {
  T value{};
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) fail(path, "'" + word + "' is no number");
  return value;
}

// "1,234" as a number; a word is none.
std::optional<std::size_t> count_in(std::string cell) {
  std::erase_if(cell, [](char c) { return c == ',' || c == ' ' || c == '`'; });
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size()) return std::nullopt;
  return value;
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::istringstream in(text);
  std::vector<std::string> parts;
  for (std::string part; std::getline(in, part, separator);) parts.push_back(part);
  return parts;
}

}  // namespace

bool available() { return fs::exists(root() / "truth" / "cameras.txt"); }

std::string missing_message() { return "ALL SKIPPED: there is no " + root().string() + "/truth"; }

std::vector<View> views() {
  const fs::path path = root() / "truth" / "cameras.txt";
  std::istringstream in(read_file(path));
  std::vector<View> result;
  for (std::string line; std::getline(in, line);) {
    if (line.empty() || line.front() == '#') continue;
    std::istringstream split(line);
    const std::vector<std::string> words{std::istream_iterator<std::string>(split), {}};
    if (words.size() != 12) fail(path, "'" + line + "' has not 12 words");
    const auto point = [&](std::size_t i) {
      return glm::vec3(parse<float>(path, words[i]), parse<float>(path, words[i + 1]),
                       parse<float>(path, words[i + 2]));
    };
    result.push_back({words[0], words[1], point(2), point(5), point(8), parse<double>(path, words[11])});
  }
  return result;
}

std::vector<View> views_of(const std::string& scene) {
  std::vector<View> result = views();
  std::erase_if(result, [&](const View& view) { return view.scene != scene; });
  return result;
}

std::vector<std::string> scenes() {
  std::vector<std::string> names;
  for (const View& view : views()) {
    if (std::find(names.begin(), names.end(), view.scene) == names.end()) names.push_back(view.scene);
  }
  return names;
}

fs::path scene_file(const std::string& scene) { return root() / "scenes" / (scene + ".ply"); }

TriangleMesh load_scene(const std::string& scene) {
  const fs::path path = scene_file(scene);
  const std::string bytes = read_file(path);
  Reader in(path, bytes);
  in.expect("ply\nformat binary_little_endian 1.0\nelement vertex ");
  const std::size_t vertices = in.number();
  in.expect("\nproperty float x\nproperty float y\nproperty float z\nelement face ");
  const std::size_t faces = in.number();
  in.expect("\nproperty list uchar int vertex_indices\nend_header\n");
  TriangleMesh mesh;
  for (std::size_t i = 0; i < vertices; ++i) mesh.positions.push_back(in.value<glm::vec3>());
  for (std::size_t i = 0; i < faces; ++i) {
    if (in.value<std::uint8_t>() != 3) fail(path, "face " + std::to_string(i) + " is no triangle");
    const auto corners = in.value<glm::uvec3>();
    if (std::max({corners.x, corners.y, corners.z}) >= vertices) {
      fail(path, "face " + std::to_string(i) + " has an index out of range");
    }
    mesh.triangles.push_back(corners);
  }
  if (!in.at_end()) fail(path, "goes on after its last face");
  return mesh;
}

std::vector<SceneFacts> scene_facts() {
  const fs::path path = root() / "scenes" / "README.md";
  std::vector<SceneFacts> result;
  for (const std::string& line : split(read_file(path), '\n')) {
    // | name | triangles | vertices | MB | class | min | max | a / b / c | duplicate | slivers | open | over
    // 2 |
    const std::vector<std::string> cells = split(line, '|');
    if (cells.size() != 13 || !cells[1].starts_with(" `")) continue;
    std::vector<std::string> degenerate = split(cells[8], '/');
    degenerate.resize(3);
    result.push_back({cells[1].substr(2, cells[1].size() - 4), count_in(cells[2]), count_in(cells[3]),
                      count_in(degenerate[0]), count_in(degenerate[1]), count_in(degenerate[2]),
                      count_in(cells[9]), count_in(cells[11]), count_in(cells[12])});
  }
  if (result.empty()) fail(path, "has no table of scenes");
  return result;
}

std::vector<Ray> rays(const std::string& scene) {
  return read_array<Ray>(root() / "truth" / (scene + ".rays.bin"));
}

std::vector<Hit> hits(const std::string& scene) {
  return read_array<Hit>(root() / "truth" / (scene + ".hits.bin"));
}

Frame frame(const View& view) {
  const fs::path path = root() / "truth" / (view.scene + "." + view.name + ".320x180.bin");
  const std::vector<Hit> pixels = read_array<Hit>(path);
  Frame result(kFrameWidth, kFrameHeight);
  if (pixels.size() != result.id.size()) fail(path, "is no frame of 320 x 180");
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    result.depth[i] = pixels[i].t;
    result.id[i] = pixels[i].id;
  }
  return result;
}

}  // namespace plumb::shared
