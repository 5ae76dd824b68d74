#include "io/descriptor.h"

#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

namespace plumb::detail {
namespace {

// Calls `part(offset, done, bytes)` until all is done. Systems read and write less than asked, and some at
// most 2 GiB.
template <typename Part>
std::size_t all_of(std::uint64_t offset, std::size_t bytes, const Part& part) {
  std::size_t done = 0;
  while (done < bytes) {
    errno = 0;
    const ssize_t count = part(static_cast<off_t>(offset + done), done, bytes - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    done += static_cast<std::size_t>(count);
  }
  return done;
}

}  // namespace

static_assert(sizeof(off_t) == 8, "files may be larger than 4 GiB");

Descriptor::~Descriptor() {
  if (is_open()) close(number_);
}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(number_, other.number_);
  return *this;
}

std::size_t Descriptor::read_at(std::uint64_t offset, char* to, std::size_t bytes) const {
  return all_of(offset, bytes, [&](off_t from, std::size_t done, std::size_t count) {
    return pread(number_, to + done, count, from);
  });
}

std::size_t Descriptor::write_at(std::uint64_t offset, const char* from, std::size_t bytes) const {
  return all_of(offset, bytes, [&](off_t to, std::size_t done, std::size_t count) {
    return pwrite(number_, from + done, count, to);
  });
}

std::string system_message() { return std::generic_category().message(errno); }

}  // namespace plumb::detail
