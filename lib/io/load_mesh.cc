#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <new>
#include <string>
#include <string_view>

#include "base/fp_mode.h"
#include "io/descriptor.h"
#include "io/mesh_file.h"
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

Reader reader_of(detail::MeshFormat format) {
  switch (format) {
    case detail::MeshFormat::Ply:
      return detail::read_ply;
    case detail::MeshFormat::Obj:
      return detail::read_obj;
    case detail::MeshFormat::Stl:
      return detail::read_stl;
    default:
      return detail::read_off;
  }
}

struct Bytes {
  std::unique_ptr<char[]> data;
  std::size_t size = 0;
};

// Reads the file rather than mapping it: a mapped file that someone cuts short is a fault in mid-read.
Bytes read_file(const fs::path& path) {
  const std::string name = path.string();
  const std::uint64_t size = detail::file_bytes(path);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(name.c_str(), "rb"), std::fclose);
  if (file == nullptr) throw Error(name + ": cannot be opened: " + detail::system_message());
  Bytes bytes{std::make_unique_for_overwrite<char[]>(size), static_cast<std::size_t>(size)};
  if (std::fread(bytes.data.get(), 1, bytes.size, file.get()) != bytes.size) {
    throw Error(name + ": cannot be read to its end: " +
                (std::ferror(file.get()) != 0 ? detail::system_message() : "it became shorter meanwhile"));
  }
  return bytes;
}

TriangleMesh load(const fs::path& path, MeshReport& report) {
  try {
    detail::check_regular_file(path);
    const Reader reader = reader_of(detail::mesh_format(path));
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
