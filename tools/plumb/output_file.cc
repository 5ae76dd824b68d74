#include "output_file.h"

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

#include "plumb/error.h"

namespace plumb::tool {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw Error(fmt::format("plumb: cannot write '{}': {}", path.string(), reason));
}

std::string system_reason(int error) { return std::generic_category().message(error); }

/// Writes and closes. The reason of the first failure, empty when there was none.
std::string write_all(const fs::path& path, std::span<const std::byte> bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (file == nullptr) return system_reason(errno);
  std::string reason;
  if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fflush(file) != 0) {
    reason = system_reason(errno);
  }
  if (std::fclose(file) != 0 && reason.empty()) reason = system_reason(errno);
  return reason;
}

}  // namespace

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    fail(folder, error ? error.message() : "it is a file, not a folder");
  }
}

void write_file(const fs::path& path, std::span<const std::byte> bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    const std::string reason = write_all(path, bytes);
    if (!reason.empty()) fail(path, reason);
    return;
  }
  const fs::path partial = fmt::format("{}.{}.part", path.string(), getpid());
  std::string reason = write_all(partial, bytes);
  if (reason.empty()) {
    fs::rename(partial, path, error);
    if (!error) return;
    reason = error.message();
  }
  fs::remove(partial, error);
  fail(path, reason);
}

void print_line(std::string_view line) {
  const bool written = std::fwrite(line.data(), 1, line.size(), stdout) == line.size() &&
                       std::fputc('\n', stdout) != EOF && std::fflush(stdout) == 0;
  if (!written) fail("standard output", system_reason(errno));
}

}  // namespace plumb::tool
