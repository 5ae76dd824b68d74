#include "io/scratch_file.h"

#include <fcntl.h>
#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include "plumb/error.h"

namespace plumb::detail {
namespace {

std::string scratch_folder() {
  std::error_code ignored;
  const std::string folder = std::filesystem::temp_directory_path(ignored).string();
  return folder.empty() ? "/tmp" : folder;
}

[[noreturn]] void fail(const std::string& what) {
  throw Error("plumb: a temporary file in " + scratch_folder() + " " + what +
              "; TMPDIR can name another folder");
}

Descriptor make_file() {
  std::string name = scratch_folder() + "/plumb-XXXXXX";
  const int number = mkostemp(name.data(), O_CLOEXEC);
  if (number < 0) fail("cannot be made: " + system_message());
  Descriptor file(number);
  unlink(name.c_str());
  return file;
}

}  // namespace

ScratchFile::ScratchFile(std::size_t buffer_bytes)
    : buffer_bytes_(buffer_bytes), buffer_(std::make_unique_for_overwrite<char[]>(buffer_bytes)) {}

void ScratchFile::write_out() {
  if (!file_.is_open()) file_ = make_file();
  if (file_.write_at(written_, buffer_.get(), filled_) != filled_) {
    fail("cannot be written: " + system_message());
  }
  written_ += filled_;
  filled_ = 0;
}

void ScratchFile::read(std::uint64_t offset, char* to, std::size_t bytes) const {
  if (offset < written_) {
    const auto stored = static_cast<std::size_t>(std::min<std::uint64_t>(bytes, written_ - offset));
    if (file_.read_at(offset, to, stored) != stored) fail("cannot be read: " + system_message());
    offset += stored;
    to += stored;
    bytes -= stored;
  }
  if (bytes > 0) std::memcpy(to, buffer_.get() + (offset - written_), bytes);
}

}  // namespace plumb::detail
