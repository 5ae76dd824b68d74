#include <fcntl.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>

#include "base/fp_mode.h"
#include "io/descriptor.h"
#include "io/mesh_file.h"
#include "io/stream_file.h"
#include "plumb/error.h"
#include "plumb/stream.h"

namespace plumb {
namespace {

namespace fs = std::filesystem;

// A file is read rather than mapped: one that someone cuts short meanwhile is an error, not a fault, and what
// was read of it is not the process's memory.
class MeshFile {
 public:
  explicit MeshFile(const fs::path& path) : name_(path.string()) {
    detail::check_regular_file(path);
    format_ = detail::mesh_format(path);
    bytes_.size = detail::file_bytes(path);
    file_ = detail::Descriptor(open(name_.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file_.is_open()) throw Error(name_ + ": cannot be opened: " + detail::system_message());
    bytes_.read = [this](std::uint64_t offset, char* to, std::size_t bytes) { read(offset, to, bytes); };
  }
  MeshFile(const MeshFile&) = delete;
  MeshFile& operator=(const MeshFile&) = delete;

  const std::string& name() const { return name_; }
  detail::MeshFormat format() const { return format_; }
  const detail::FileBytes& bytes() const { return bytes_; }

 private:
  void read(std::uint64_t offset, char* to, std::size_t bytes) const {
    if (file_.read_at(offset, to, bytes) == bytes) return;
    throw Error(name_ + ": cannot be read to its end: " +
                (errno != 0 ? detail::system_message() : "it became shorter meanwhile"));
  }

  std::string name_;
  detail::MeshFormat format_;
  detail::Descriptor file_;
  detail::FileBytes bytes_;
};

MeshReport stream(const fs::path& path, const detail::PartSink& part, const StreamOptions& options) {
  const MeshFile file(path);
  detail::MeshLimits limits;
  limits.triangles = kNone - options.first_id;
  limits.first_id = options.first_id;
  return detail::stream_file({file.bytes(), file.format(), file.name(), limits,
                              detail::stream_sizes(options.memory_bytes), options.progress},
                             part);
}

}  // namespace

MeshReport stream_mesh(const fs::path& path,
                       const std::function<void(MeshView part, std::uint32_t first_id)>& part,
                       const StreamOptions& options) {
  if (options.memory_bytes < detail::kLeastStreamMemory) {
    throw Error("plumb: stream_mesh: memory_bytes is " + std::to_string(options.memory_bytes) +
                "; it must be at least " + std::to_string(detail::kLeastStreamMemory));
  }
  return detail::with_default_fp_mode([&] { return stream(path, part, options); });
}

}  // namespace plumb
