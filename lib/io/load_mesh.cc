#include <array>
#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <system_error>

#include "base/fp_mode.h"
#include "io/memory.h"
#include "io/obj.h"
#include "io/off.h"
#include "io/ply.h"
#include "io/stl.h"
#include "plumb/error.h"
#include "plumb/io.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;

using Reader = TriangleMesh (*)(std::string_view bytes, const std::string& file, MeshReport& report,
                                const detail::MeshLimits& limits);

struct Format {
  const char* extension;
  Reader reader;
};

constexpr std::array<Format, 4> kFormats = {{{".ply", detail::read_ply},
                                             {".obj", detail::read_obj},
                                             {".stl", detail::read_stl},
                                             {".off", detail::read_off}}};

Reader reader_for(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  std::string known;
  for (const Format& format : kFormats) {
    if (extension == format.extension) return format.reader;
    known += std::string(known.empty() ? "" : ", ") + format.extension;
  }
  throw Error(path.string() + ": the extension \"" + extension + "\" names no mesh format; known: " + known);
}

std::string system_message() { return std::generic_category().message(errno); }

struct Bytes {
  std::unique_ptr<char[]> data;
  std::size_t size = 0;
};

void check_regular_file(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (error) throw Error(name + ": " + error.message());
  if (fs::is_directory(status)) throw Error(name + ": is a directory, not a mesh file");
  if (!fs::is_regular_file(status)) throw Error(name + ": is not a regular file");
}

// Reads the file rather than mapping it: a mapped file that someone cuts short is a fault in mid-read.
Bytes read_file(const fs::path& path) {
  const std::string name = path.string();
  std::error_code error;
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) throw Error(name + ": " + error.message());
  if (size == 0) throw Error(name + ": the file is empty");

  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), std::fclose);
  if (file == nullptr) throw Error(name + ": cannot be opened: " + system_message());
  Bytes bytes{std::make_unique_for_overwrite<char[]>(size), static_cast<std::size_t>(size)};
  detail::expect_writes(bytes.data.get(), bytes.size);
  if (std::fread(bytes.data.get(), 1, bytes.size, file.get()) != bytes.size) {
    throw Error(name + ": cannot be read to its end: " +
                (std::ferror(file.get()) != 0 ? system_message() : "it became shorter meanwhile"));
  }
  return bytes;
}

TriangleMesh load(const fs::path& path, MeshReport& report) {
  try {
    check_regular_file(path);
    const Reader reader = reader_for(path);
    const Bytes bytes = read_file(path);
    return reader({bytes.data.get(), bytes.size}, path.string(), report, {});
  } catch (const std::bad_alloc&) {
    throw Error(path.string() + ": there is not enough memory for this mesh");
  }
}

}  // namespace

TriangleMesh load_mesh(const fs::path& path, MeshReport* report) {
  MeshReport unwanted;
  return detail::with_default_fp_mode([&] { return load(path, report != nullptr ? *report : unwanted); });
}

}  // namespace plumb
