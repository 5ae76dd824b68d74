#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "io/stream_file.h"
#include "plumb/error.h"
#include "plumb/io.h"
#include "plumb/mesh.h"

// Whether a mesh file that is streamed gives what it gives in one piece.

namespace plumb::test {

/// What reading a file gave: a mesh and its report, or an error.
struct Outcome {
  TriangleMesh mesh;
  MeshReport report;
  std::string error;
};

/// Calls `read` for the mesh and the report.
template <typename Read>
Outcome outcome_of(const Read& read) {
  Outcome outcome;
  try {
    read(outcome);
  } catch (const Error& error) {
    outcome = {};
    outcome.error = error.what();
  }
  return outcome;
}

inline bool same_report(const MeshReport& a, const MeshReport& b) {
  return a.vertices == b.vertices && a.faces == b.faces && a.triangles == b.triangles &&
         a.non_finite_vertices == b.non_finite_vertices && a.unseen_triangles == b.unseen_triangles;
}

/// The corners of parts, put together again.
class Joined {
 public:
  explicit Joined(std::uint64_t first_id = 0) : next_id_(first_id) {}

  void add(MeshView part, std::uint32_t first_id) {
    if (first_id != next_id_) fault = "a part does not begin where the one before ended";
    if (part.triangles.empty()) fault = "a part is empty";
    std::vector<char> used(part.positions.size(), 0);
    for (const glm::uvec3& t : part.triangles) {
      for (int k = 0; k < 3; ++k) {
        if (t[k] >= part.positions.size()) {
          fault = "an index is out of range";
          return;
        }
        used[t[k]] = 1;
        corners.push_back(part.positions[t[k]]);
      }
    }
    if (std::count(used.begin(), used.end(), 0) != 0) fault = "a part has a vertex that it does not use";
    next_id_ += part.triangles.size();
    greatest_part = std::max(greatest_part, part.triangles.size());
    ++parts;
  }

  /// What is not as in the mesh, bit for bit; nothing when all is.
  std::string difference(const TriangleMesh& mesh) const {
    if (!fault.empty()) return fault;
    if (corners.size() != 3 * mesh.triangles.size()) return "there is another number of triangles";
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const glm::vec3& expected = mesh.positions[mesh.triangles[i / 3][static_cast<int>(i % 3)]];
      if (std::memcmp(&corners[i], &expected, sizeof(glm::vec3)) != 0) {
        return "triangle " + std::to_string(i / 3) + " has another corner";
      }
    }
    return "";
  }

  std::vector<glm::vec3> corners;
  std::string fault;
  std::size_t greatest_part = 0, parts = 0;

 private:
  std::uint64_t next_id_;
};

/// Bytes that are "read" from memory.
inline detail::FileBytes bytes_in_memory(std::string_view bytes) {
  return {bytes.size(), [bytes](std::uint64_t offset, char* to, std::size_t count) {
            if (offset > bytes.size() || count > bytes.size() - offset)
              throw Error("read outside of the file");
            std::memcpy(to, bytes.data() + offset, count);
          }};
}

/// The longest run of characters without a blank or a line's end.
inline std::size_t longest_word(std::string_view bytes) {
  std::size_t longest = 0, length = 0;
  for (const char c : bytes) {
    length = std::string_view(" \t\v\f\r\n").find(c) == std::string_view::npos ? length + 1 : 0;
    longest = std::max(longest, length);
  }
  return longest;
}

/// Sizes as small as the file allows, so that every step is taken even for a file of a few lines.
inline detail::StreamSizes smallest_sizes(std::string_view bytes, std::size_t part_triangles,
                                          std::size_t buffer_bytes = 64) {
  const std::size_t word = std::max<std::size_t>(longest_word(bytes), 64);
  return {std::max<std::size_t>(word + 3, 128), word, std::size_t{1} << 30, buffer_bytes, part_triangles};
}

/// What streaming the bytes does differently than reading them in one piece did; nothing when all is the
/// same. `file` is a name whose ending says the format.
inline std::string stream_difference(const std::string& file, std::string_view bytes,
                                     const detail::MeshLimits& limits, const Outcome& whole,
                                     const detail::StreamSizes& sizes) {
  if (bytes.empty()) return "";  // refused before any reader
  const detail::FileBytes in_memory = bytes_in_memory(bytes);
  Joined joined(limits.first_id);
  const Outcome streamed = outcome_of([&](Outcome& outcome) {
    outcome.report =
        detail::stream_file({in_memory, detail::mesh_format(file), file, limits, sizes, {}},
                            [&](MeshView part, std::uint32_t first_id) { joined.add(part, first_id); });
  });
  if (streamed.error != whole.error) return "another error: " + streamed.error + " / " + whole.error;
  if (!joined.fault.empty()) return joined.fault;
  if (joined.greatest_part > sizes.part_triangles) return "a part is too large";
  if (!whole.error.empty()) return "";
  if (!same_report(streamed.report, whole.report)) return "another report";
  return joined.difference(whole.mesh);
}

}  // namespace plumb::test
