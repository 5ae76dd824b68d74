#include "io/cursor.h"

#include <algorithm>
#include <cstring>

namespace plumb::detail {

WindowCursor::WindowCursor(const Window& window, std::uint64_t offset)
    : window_(&window),
      buffer_(std::make_unique_for_overwrite<char[]>(window.bytes)),
      base_(offset),
      reach_(window.longest_word + 2) {
  at = end = buffer_.get();
}

void WindowCursor::skip(std::uint64_t bytes) {
  if (bytes <= static_cast<std::uint64_t>(end - at)) {
    at += bytes;
    return;
  }
  base_ = offset() + bytes;
  at = end = buffer_.get();
}

void WindowCursor::move_on() {
  const std::uint64_t here = offset();
  if (window_->on_read) window_->on_read(here);
  const auto kept = static_cast<std::size_t>(end - at);
  std::memmove(buffer_.get(), at, kept);
  const std::uint64_t unread = window_->file.size - here - kept;
  const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(unread, window_->bytes - kept));
  if (bytes > 0) window_->file.read(here + kept, buffer_.get() + kept, bytes);
  base_ = here;
  at = buffer_.get();
  end = at + kept + bytes;
  if (bytes == unread) reach_ = 0;
}

}  // namespace plumb::detail
