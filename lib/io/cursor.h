#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

// Where readers take a file's bytes from: cursors of one interface, over a file that is in memory whole and
// over a window that moves along one that is not. Pointers into the bytes hold until the next hold() or
// hold_word().

namespace plumb::detail {

/// A place in bytes that are all in memory. What would bring more of them does nothing here.
class WholeCursor {
 public:
  explicit WholeCursor(std::string_view bytes)
      : at(bytes.data()), end(bytes.data() + bytes.size()), begin_(bytes.data()) {}

  const char* at;   ///< the next byte
  const char* end;  ///< behind the last that is in memory

  /// Brings the next `bytes` bytes into memory, few of them; false when the file has not so many left.
  bool hold(std::size_t bytes) const { return static_cast<std::size_t>(end - at) >= bytes; }

  /// Brings the longest word that may be here into memory, and two characters more; at == end is then the
  /// file's end.
  void hold_word() const {}

  /// Whether a word may be so long.
  static constexpr bool is_word(std::ptrdiff_t /*length*/) { return true; }

  /// Bytes of the file before this place, and from it on.
  std::uint64_t offset() const { return static_cast<std::uint64_t>(at - begin_); }
  std::uint64_t left() const { return static_cast<std::uint64_t>(end - at); }

  /// Passes over bytes, at most left().
  void skip(std::uint64_t bytes) { at += bytes; }

 private:
  const char* begin_;
};

/// The bytes of a file that is read as they are needed.
struct FileBytes {
  std::uint64_t size = 0;
  /// Reads bytes that are there, from an offset on. Throws plumb::Error.
  std::function<void(std::uint64_t offset, char* to, std::size_t bytes)> read;
};

/// A file and how much of it is in memory at a time.
struct Window {
  const FileBytes& file;
  std::size_t bytes;                                  ///< more than longest_word + 2
  std::size_t longest_word;                           ///< of a text; at least 64
  std::function<void(std::uint64_t offset)> on_read;  ///< called when all before the offset was read
};

/// A place in a file of which a window is in memory. WholeCursor says what its members do.
class WindowCursor {
 public:
  WindowCursor(const Window& window, std::uint64_t offset);

  const char* at;
  const char* end;

  bool hold(std::size_t bytes) {
    if (static_cast<std::size_t>(end - at) >= bytes) [[likely]]
      return true;
    move_on();
    return static_cast<std::size_t>(end - at) >= bytes;
  }

  void hold_word() {
    if (static_cast<std::size_t>(end - at) < reach_) [[unlikely]]
      move_on();
  }

  bool is_word(std::ptrdiff_t length) const {
    return static_cast<std::size_t>(length) <= window_->longest_word;
  }

  std::uint64_t offset() const { return base_ + static_cast<std::uint64_t>(at - buffer_.get()); }
  std::uint64_t left() const { return window_->file.size - offset(); }
  void skip(std::uint64_t bytes);

 private:
  // Makes the byte at `at` the first of the window and fills the rest.
  void move_on();

  const Window* window_;
  std::unique_ptr<char[]> buffer_;
  std::uint64_t base_;  // the offset of the window's first byte
  std::size_t reach_;   // what hold_word() brings; 0 when the window reaches the file's end
};

}  // namespace plumb::detail
