#include "io/mesh_file.h"

#include <array>
#include <string>
#include <system_error>
#include <utility>

#include "plumb/error.h"

namespace plumb::detail {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::pair<const char*, MeshFormat>, 4> kExtensions = {{{".ply", MeshFormat::Ply},
                                                                            {".obj", MeshFormat::Obj},
                                                                            {".stl", MeshFormat::Stl},
                                                                            {".off", MeshFormat::Off}}};

}  // namespace

MeshFormat mesh_format(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  std::string known;
  for (const auto& [name, format] : kExtensions) {
    if (extension == name) return format;
    known += std::string(known.empty() ? "" : ", ") + name;
  }
  throw Error(path.string() + ": the extension \"" + extension + "\" names no mesh format; known: " + known);
}

void check_regular_file(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error) throw Error(name + ": " + error.message());
  if (fs::is_directory(status)) throw Error(name + ": is a directory, not a mesh file");
  if (!fs::is_regular_file(status)) throw Error(name + ": is not a regular file");
}

std::uint64_t file_bytes(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw Error(name + ": " + error.message());
  if (size == 0) throw Error(name + ": the file is empty");
  return size;
}

}  // namespace plumb::detail
