#include "io/stl.h"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "io/binary.h"
#include "io/cursor.h"
#include "io/mesh_parts.h"
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

// What the first bytes of a file and its length tell.
struct StlStart {
  std::string_view header;  // kHeaderBytes, or all that there are
  std::uint64_t file_bytes;
  bool begins_with_solid;

  std::uint64_t count() const { return load_binary<std::uint32_t, kSwap>(header.data() + kCountAt); }
};

// Many binary files begin with "solid" too. But no text has a zero byte, and each binary file of fewer
// than 2^24 triangles has one in its count; and the length of a text would have to be 84 + 50 times what
// four of its characters make as an integer, which is 7 GB or more.
bool is_text(const StlStart& start) {
  if (!start.begins_with_solid) return false;
  if (start.file_bytes < kHeaderBytes) return true;
  if (start.file_bytes - kHeaderBytes == start.count() * kTriangleBytes) return false;
  return start.header.find('\0') == std::string_view::npos;
}

glm::vec3 load_point(const char* at) {
  return {load_binary<float, kSwap>(at), load_binary<float, kSwap>(at + 4),
          load_binary<float, kSwap>(at + 8)};
}

std::uint64_t check_binary_header(const StlStart& start, const std::string& file, const MeshLimits& limits) {
  if (start.file_bytes < kHeaderBytes) {
    fail_in_file(file, "byte " + std::to_string(start.file_bytes),
                 "the file ends within the 84 bytes of a binary STL file's header, and a text begins with "
                 "\"solid\"");
  }
  const std::string place = "byte " + std::to_string(kCountAt);
  const std::uint64_t triangles = start.count();
  const std::uint64_t left = start.file_bytes - kHeaderBytes;
  if (triangles > left / kTriangleBytes) {
    const std::string or_text = ", or is a text that does not begin with \"solid\"";
    fail_in_file(file, place,
                 cut_short("the count of triangles", triangles, kTriangleBytes, left) +
                     (start.begins_with_solid ? "" : or_text));
  }
  if (triangles > limits.triangles) fail_in_file(file, place, too_many_triangles(limits));
  if (3 * triangles > limits.vertices) fail_in_file(file, place, too_many("vertices", limits.vertices));
  return triangles;
}

template <class Cursor, class Mesh>
void read_binary(Cursor cursor, std::uint64_t triangles, MeshBuilder<Mesh>& builder) {
  builder.reserve(3 * triangles, triangles);
  cursor.skip(kHeaderBytes);
  std::uint32_t vertex = 0;
  for (std::uint64_t i = 0; i < triangles; ++i, cursor.at += kTriangleBytes) {
    cursor.hold(kTriangleBytes);
    for (std::size_t corner = 1; corner <= 3; ++corner) {  // the normal is point 0
      builder.add_vertex(load_point(cursor.at + corner * kVertexBytes));
    }
    builder.add_triangle(vertex, vertex + 1, vertex + 2);
    vertex += 3;
  }
}

// `make_cursor()` gives one at the file's beginning.
template <class MakeCursor, class Mesh>
void read_file(const MakeCursor& make_cursor, std::uint64_t file_bytes, const std::string& file,
               MeshBuilder<Mesh>& builder) {
  auto first = make_cursor();
  first.hold(kHeaderBytes);
  const std::size_t header_bytes = std::min<std::uint64_t>(kHeaderBytes, file_bytes);
  const StlStart start{{first.at, header_bytes}, file_bytes, begins_with_solid(make_cursor())};
  if (is_text(start)) {
    StlTextReader(make_cursor(), file, builder).read();
  } else {
    read_binary(make_cursor(), check_binary_header(start, file, builder.limits()), builder);
  }
}

}  // namespace

TriangleMesh read_stl(std::string_view bytes, const std::string& file, MeshReport& report,
                      const MeshLimits& limits) {
  MeshBuilder<WholeMesh> builder(limits);
  read_file([&] { return WholeCursor(bytes); }, bytes.size(), file, builder);
  report = builder.report();
  return builder.mesh().take();
}

MeshReport stream_stl(const StreamJob& job) {
  MeshBuilder builder(job.limits, SeparateParts(job));
  read_file([&] { return WindowCursor(job.window, 0); }, job.window.file.size, job.name, builder);
  builder.mesh().finish();
  return builder.report();
}

}  // namespace plumb::detail
