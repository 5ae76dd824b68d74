#include "io/ply.h"

#include <bit>
#include <utility>

#include "io/ply_ascii.h"
#include "io/ply_binary.h"
#include "io/ply_header.h"
#include "io/text.h"

// The body is read by own code too: OpenMesh 9.0, for one, takes the first property of a face for its
// vertex indices whatever it is, loses its place at lists and at integer coordinates of vertices, turns
// all that follows a text "nan" or "inf" into zeros and reports success, and keeps its state in a
// singleton, so that two threads cannot read at once.

namespace plumb::detail {
namespace {

template <typename Source>
class BodyReader {
 public:
  BodyReader(Source source, const PlyHeader& header, MeshBuilder& builder)
      : source_(source), header_(header), builder_(builder) {}

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
      source_.begin_row(element, row);
      for (const PlyProperty& property : element.properties) read_property(property);
      source_.end_row();
      if (is_vertex) builder_.mesh().positions.push_back(point_);
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
        source_.fail(too_many("triangles", builder_.limits().triangles));
      }
    });
  }

  Source source_;
  const PlyHeader& header_;
  MeshBuilder& builder_;
  glm::vec3 point_{0.0f, 0.0f, 0.0f};
};

template <typename Source>
void read_body(std::string_view bytes, const PlyHeader& header, const std::string& file,
               MeshBuilder& builder) {
  BodyReader<Source>(Source(bytes, header, file), header, builder).read();
}

}  // namespace

TriangleMesh read_ply(std::string_view bytes, const std::string& file, MeshReport& report,
                      const MeshLimits& limits) {
  const PlyHeader header = read_ply_header(bytes, file, limits);
  constexpr PlyFormat kNative =
      std::endian::native == std::endian::little ? PlyFormat::BinaryLittleEndian : PlyFormat::BinaryBigEndian;
  MeshBuilder builder(limits);
  if (header.format == PlyFormat::Ascii) {
    read_body<PlyAsciiSource>(bytes, header, file, builder);
  } else if (header.format == kNative) {
    read_body<PlyBinarySource<false>>(bytes, header, file, builder);
  } else {
    read_body<PlyBinarySource<true>>(bytes, header, file, builder);
  }
  report = builder.report();
  return std::move(builder.mesh());
}

}  // namespace plumb::detail
