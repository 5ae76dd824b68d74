#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>

#include "io/descriptor.h"

namespace plumb::detail {

/// Bytes that grow at their end and are read anywhere, of which a buffer is in memory. What does not fit it
/// is in a file without a name in the folder for temporary files (TMPDIR), which is gone when this ends,
/// however the process does.
class ScratchFile {
 public:
  explicit ScratchFile(std::size_t buffer_bytes);

  /// At most as many as the buffer holds. Throws plumb::Error when there is no place for them.
  void append(const void* data, std::size_t bytes) {
    if (filled_ + bytes > buffer_bytes_) [[unlikely]]
      write_out();
    std::memcpy(buffer_.get() + filled_, data, bytes);
    filled_ += bytes;
  }

  std::uint64_t size() const { return written_ + filled_; }

  /// Reads bytes that were appended. Throws plumb::Error.
  void read(std::uint64_t offset, char* to, std::size_t bytes) const;

 private:
  void write_out();

  std::size_t buffer_bytes_;
  std::unique_ptr<char[]> buffer_;
  std::size_t filled_ = 0;
  Descriptor file_;
  std::uint64_t written_ = 0;
};

}  // namespace plumb::detail
