#include "io/stl.h"

#include <bit>
#include <cstdint>
#include <utility>

#include "io/binary.h"
#include "io/stl_text.h"
#include "io/text.h"

// The format: 3D Systems, "StereoLithography Interface Specification", 1989.

namespace plumb::detail {
namespace {

constexpr bool kSwap = std::endian::native != std::endian::little;

// A binary file: 80 bytes of any content, the count of triangles, then of each triangle a normal and
// three vertices (12 floats) and a 16-bit attribute.
constexpr std::size_t kCountAt = 80;
constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kVertexBytes = 12;
constexpr std::size_t kTriangleBytes = 50;

std::uint64_t count_of(std::string_view bytes) {
  return load_binary<std::uint32_t, kSwap>(bytes.data() + kCountAt);
}

// Many binary files begin with "solid" too. But no text has a zero byte, and each binary file of fewer
// than 2^24 triangles has one in its count; and the length of a text would have to be 84 + 50 times what
// four of its characters make as an integer, which is 7 GB or more.
bool is_text(std::string_view bytes) {
  if (!begins_with_solid(bytes)) return false;
  if (bytes.size() < kHeaderBytes) return true;
  if (bytes.size() - kHeaderBytes == count_of(bytes) * kTriangleBytes) return false;
  return bytes.substr(0, kHeaderBytes).find('\0') == std::string_view::npos;
}

glm::vec3 load_point(const char* at) {
  return {load_binary<float, kSwap>(at), load_binary<float, kSwap>(at + 4),
          load_binary<float, kSwap>(at + 8)};
}

std::uint64_t read_binary_header(std::string_view bytes, const std::string& file, const MeshLimits& limits) {
  if (bytes.size() < kHeaderBytes) {
    fail_in_file(file, "byte " + std::to_string(bytes.size()),
                 "the file ends within the 84 bytes of a binary STL file's header, and a text begins with "
                 "\"solid\"");
  }
  const std::string place = "byte " + std::to_string(kCountAt);
  const std::uint64_t triangles = count_of(bytes);
  const std::uint64_t left = bytes.size() - kHeaderBytes;
  if (triangles > left / kTriangleBytes) {
    const std::string or_text = ", or is a text that does not begin with \"solid\"";
    fail_in_file(file, place,
                 cut_short("the count of triangles", triangles, kTriangleBytes, left) +
                     (begins_with_solid(bytes) ? "" : or_text));
  }
  if (triangles > limits.triangles) fail_in_file(file, place, too_many("triangles", limits.triangles));
  if (3 * triangles > limits.vertices) fail_in_file(file, place, too_many("vertices", limits.vertices));
  return triangles;
}

void read_binary(std::string_view bytes, const std::string& file, MeshBuilder& builder) {
  const std::uint64_t triangles = read_binary_header(bytes, file, builder.limits());
  builder.reserve(3 * triangles, triangles);
  const char* at = bytes.data() + kHeaderBytes;
  std::uint32_t vertex = 0;
  for (std::uint64_t i = 0; i < triangles; ++i, at += kTriangleBytes) {
    builder.begin_polygon();
    for (std::size_t corner = 1; corner <= 3; ++corner) {  // the normal is point 0
      builder.mesh().positions.push_back(load_point(at + corner * kVertexBytes));
      builder.add_corner(vertex++);
    }
    builder.end_polygon();
  }
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const std::string& file, MeshReport& report,
                      const MeshLimits& limits) {
  MeshBuilder builder(limits);
  if (is_text(bytes)) {
    read_stl_text(bytes, file, builder);
  } else {
    read_binary(bytes, file, builder);
  }
  report = builder.report();
  return std::move(builder.mesh());
}

}  // namespace plumb::detail
