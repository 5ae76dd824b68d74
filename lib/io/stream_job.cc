#include "io/stream_job.h"

#include <algorithm>

#include "plumb/error.h"

namespace plumb::detail {

// A tenth is left for what grows with nothing: the header, names, the system's own buffers.
StreamSizes stream_sizes(std::size_t memory_bytes) {
  constexpr std::size_t kMostWindow = std::size_t{1} << 22;
  StreamSizes sizes{};
  sizes.longest_word = std::size_t{1} << 16;
  sizes.window_bytes = std::clamp(memory_bytes / 16, 2 * sizes.longest_word, kMostWindow);
  sizes.header_bytes = memory_bytes / 4;
  sizes.buffer_bytes = std::clamp(memory_bytes / 64, std::size_t{1} << 14, std::size_t{1} << 20);
  // Buffers: of copies, of what is postponed, of its way back, of positions.
  const std::size_t buffers = sizes.window_bytes + 4 * sizes.buffer_bytes;
  // A corner's place in its part is a number of 32 bits.
  constexpr std::size_t kMostTriangles = 0xffffffffu / 3;
  sizes.part_triangles =
      std::min((memory_bytes - memory_bytes / 10 - buffers) / kPartTriangleBytes, kMostTriangles);
  return sizes;
}

StreamProgress::StreamProgress(const std::function<bool(double)>& callback, std::uint64_t file_bytes)
    : callback_(callback), file_bytes_(static_cast<double>(file_bytes)) {}

// What is postponed takes a first half of the share left to be read, and a second to be given.
void StreamProgress::read_to(std::uint64_t offset) {
  const double share = static_cast<double>(offset) / file_bytes_;
  report(share <= postponed_at_ ? share : (postponed_at_ + share) / 2);
}

void StreamProgress::given(double share) {
  const double left = 1.0 - postponed_at_;
  report(postponed_at_ + left * (1.0 + share) / 2);
}

void StreamProgress::report(double share) {
  share_ = std::max(share_, std::min(share, 1.0));
  if (callback_ && !callback_(share_)) throw Cancelled("plumb: cancelled by the progress callback");
}

}  // namespace plumb::detail
