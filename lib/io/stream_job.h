#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "io/cursor.h"
#include "io/mesh_builder.h"
#include "plumb/mesh.h"

namespace plumb::detail {

/// How much of a file and of its mesh is in memory at a time.
struct StreamSizes {
  std::size_t window_bytes;    ///< of the file, where it is read from front to back
  std::size_t longest_word;    ///< of a text; a longer one is refused
  std::size_t header_bytes;    ///< of a PLY header; a longer one is refused
  std::size_t buffer_bytes;    ///< of vertices on their way to and from the disk; at least 64
  std::size_t part_triangles;  ///< of a part given
};

/// Sizes that add up to no more than so many bytes, at least kLeastStreamMemory.
StreamSizes stream_sizes(std::size_t memory_bytes);
inline constexpr std::size_t kLeastStreamMemory = std::size_t{1} << 20;

/// Bytes that a triangle of a part takes in memory, at most (MeshParts): its corners; the numbers of its
/// vertices and their positions, if no other triangle uses them; and what it takes to number these.
inline constexpr std::size_t kPartTriangleBytes = 84;

/// Turns what was read, and what was then given again, into shares for a callback.
class StreamProgress {
 public:
  /// The callback may be empty.
  StreamProgress(const std::function<bool(double)>& callback, std::uint64_t file_bytes);

  // Each throws Cancelled when the callback returns false.

  /// All before the offset was read.
  void read_to(std::uint64_t offset);
  /// From here on, what is read is given only when all is read.
  void postpone() { postponed_at_ = share_; }
  /// This share of what was postponed has been given.
  void given(double share);
  /// All is done.
  void end() { report(1.0); }

 private:
  void report(double share);

  const std::function<bool(double)>& callback_;
  double file_bytes_;
  double share_ = 0.0;
  double postponed_at_ = 1.0;
};

/// Takes a part of a mesh: a view that lives as long as the call, and the id of its first triangle.
using PartSink = std::function<void(MeshView part, std::uint32_t first_id)>;

/// What a reader needs to give a file's mesh in parts.
struct StreamJob {
  const Window& window;
  const std::string& name;  ///< of the file, in messages
  const MeshLimits& limits;
  const StreamSizes& sizes;
  StreamProgress& progress;
  const PartSink& sink;
};

}  // namespace plumb::detail
