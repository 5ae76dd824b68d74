#include "io/ply.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>
#include <vector>

#include "io/cursor.h"
#include "io/mesh_parts.h"
#include "io/ply_ascii.h"
#include "io/ply_binary.h"
#include "io/ply_header.h"
#include "io/text.h"
#include "io/vertex_rows.h"

// The body is read by own code too: OpenMesh 9.0, for one, takes the first property of a face for its
// vertex indices whatever it is, loses its place at lists and at integer coordinates of vertices, turns
// all that follows a text "nan" or "inf" into zeros and reports success, and keeps its state in a
// singleton, so that two threads cannot read at once.

namespace plumb::detail {
namespace {

template <class Source, class Mesh>
class BodyReader {
 public:
  BodyReader(Source source, const PlyHeader& header, MeshBuilder<Mesh>& builder)
      : source_(std::move(source)), header_(header), builder_(builder) {}

  void read() {
    // The header's counts are known to fit the file.
    builder_.reserve(header_.vertices, header_.faces);
    for (const PlyElement& element : header_.elements) {
      if (!element.properties.empty()) read_element(element);
    }
  }

 private:
  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex";
    const bool is_face = element.name == "face";
    for (std::uint64_t row = 0; row < element.count; ++row) {
      if (is_face) {
        row += source_.plain_triangles(element, element.count - row, header_.vertices,
                                       [&](auto... corners) { return builder_.add_triangle(corners...); });
        if (row == element.count) break;
      }
      source_.begin_row(element, row);
      for (const PlyProperty& property : element.properties) read_property(property);
      source_.end_row();
      if (is_vertex) builder_.add_vertex(point_);
      if (is_face) builder_.end_polygon();
    }
  }

  void read_property(const PlyProperty& property) {
    switch (property.use) {
      case PlyUse::X:
        point_.x = source_.real(property);
        break;
      case PlyUse::Y:
        point_.y = source_.real(property);
        break;
      case PlyUse::Z:
        point_.z = source_.real(property);
        break;
      case PlyUse::Corners:
        read_corners(property);
        break;
      case PlyUse::Nothing:
        source_.skip(property.is_list ? read_length(property) : 1, property);
        break;
    }
  }

  std::uint64_t read_length(const PlyProperty& property) {
    const std::int64_t length = source_.integer(property.count_type, property);
    if (length < 0) {
      source_.fail("list " + in_quotes(property.name) + " has the negative length " + std::to_string(length));
    }
    return static_cast<std::uint64_t>(length);
  }

  void read_corners(const PlyProperty& property) {
    const std::uint64_t corners = read_length(property);
    if (corners < 3) source_.fail(too_few_corners(corners));
    builder_.begin_polygon();
    source_.integers(corners, property, [&](std::int64_t index) {
      if (index < 0 || static_cast<std::uint64_t>(index) >= header_.vertices) {
        source_.fail(index_out_of_range(index, header_.vertices));
      }
      if (!builder_.add_corner(static_cast<std::uint32_t>(index))) {
        source_.fail(too_many_triangles(builder_.limits()));
      }
    });
  }

  Source source_;
  const PlyHeader& header_;
  MeshBuilder<Mesh>& builder_;
  glm::vec3 point_{0.0f, 0.0f, 0.0f};
};

constexpr PlyFormat kNative =
    std::endian::native == std::endian::little ? PlyFormat::BinaryLittleEndian : PlyFormat::BinaryBigEndian;

// The cursor is at the file's beginning.
template <class Cursor, class Mesh>
void read_body(Cursor cursor, const PlyHeader& header, const std::string& file, MeshBuilder<Mesh>& builder) {
  cursor.skip(header.bytes);
  const auto read = [&](auto source) { BodyReader(std::move(source), header, builder).read(); };
  if (header.format == PlyFormat::Ascii) {
    read(PlyAsciiSource<Cursor>(std::move(cursor), header, file));
  } else if (header.format == kNative) {
    read(PlyBinarySource<false, Cursor>(std::move(cursor), header, file));
  } else {
    read(PlyBinarySource<true, Cursor>(std::move(cursor), header, file));
  }
}

// The header alone, of a file that is not in memory: its beginning is read, and twice as much until the
// header is in it.
PlyHeader read_header_of(const StreamJob& job) {
  const FileBytes& file = job.window.file;
  std::vector<char> bytes;
  for (std::uint64_t size = 4096;; size *= 2) {
    size = std::min<std::uint64_t>({size, job.sizes.header_bytes, file.size});
    bytes.resize(static_cast<std::size_t>(size));
    file.read(0, bytes.data(), bytes.size());
    const std::string_view start(bytes.data(), bytes.size());
    if (auto header = read_ply_header(start, file.size, job.name, job.limits)) return std::move(*header);
    if (size == job.sizes.header_bytes) {
      fail_in_file(job.name, "byte " + std::to_string(size),
                   "the header goes on; it is too long for the memory that a stream may take");
    }
  }
}

// Bytes of a row without lists, all of which are equally long; the others have no such length.
std::optional<std::uint64_t> row_bytes(const PlyElement& element) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) return std::nullopt;
    bytes += size_of(property.type);
  }
  return bytes;
}

VertexRow vertex_row(const PlyElement& vertex, bool swapped) {
  VertexRow row;
  row.swapped = swapped;
  row.bytes = 0;
  for (const PlyProperty& property : vertex.properties) {
    if (property.use != PlyUse::Nothing) {
      const auto axis = static_cast<std::size_t>(property.use) - static_cast<std::size_t>(PlyUse::X);
      row.at.at(axis) = row.bytes;
      row.type.at(axis) = property.type;
    }
    row.bytes += size_of(property.type);
  }
  return row;
}

// Tells the mesh where the file has its vertices, if they and all before them are in rows of equal length.
void find_vertices(const PlyHeader& header, std::size_t longest_row, IndexedParts& mesh) {
  if (header.format == PlyFormat::Ascii) return;
  std::uint64_t offset = header.bytes;
  for (const PlyElement& element : header.elements) {
    const std::optional<std::uint64_t> bytes = row_bytes(element);
    if (!bytes) return;
    if (element.name == "vertex") {
      if (element.count > 0 && *bytes <= longest_row) {
        mesh.keep_in_place(vertex_row(element, header.format != kNative), offset);
      }
      return;
    }
    offset += element.count * *bytes;
  }
}

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& file, MeshReport& report,
                      const MeshLimits& limits) {
  const PlyHeader header = *read_ply_header(bytes, bytes.size(), file, limits);
  MeshBuilder<WholeMesh> builder(limits);
  read_body(WholeCursor(bytes), header, file, builder);
  report = builder.report();
  return builder.mesh().take();
}

MeshReport stream_ply(const StreamJob& job) {
  const PlyHeader header = read_header_of(job);
  MeshBuilder builder(job.limits, IndexedParts(job));
  find_vertices(header, job.sizes.buffer_bytes, builder.mesh());
  read_body(WindowCursor(job.window, 0), header, job.name, builder);
  builder.mesh().finish();
  return builder.report();
}

}  // namespace plumb::detail
