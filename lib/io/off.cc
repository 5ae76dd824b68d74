#include "io/off.h"

#include <cstdint>
#include <utility>

#include "io/lexer.h"
#include "io/mesh_parts.h"
#include "io/text.h"

// The format: the Geomview manual, "OFF Files", with the header needed and a row in one line.

namespace plumb::detail {
namespace {

template <class Cursor, class Mesh>
class OffReader {
 public:
  OffReader(Cursor text, const std::string& file, MeshBuilder<Mesh>& builder)
      : file_(file), lexer_(std::move(text)), builder_(builder) {}

  void read() {
    read_header();
    read_counts();
    // The counts are known to fit the file.
    builder_.reserve(vertices_, faces_);
    element_ = "vertex";
    for (row_ = 0; row_ < vertices_; ++row_) read_vertex();
    element_ = "face";
    for (row_ = 0; row_ < faces_; ++row_) read_face();
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    std::string place = "line " + std::to_string(lexer_.line());
    if (element_ != nullptr) place += std::string(" (") + element_ + " " + std::to_string(row_) + ")";
    fail_in_file(file_, place, reason);
  }

  // [ST][C][N]OFF. The case of letters tells: nOFF has vertices of n coordinates, NOFF has normals.
  void read_header() {
    const std::string expected = "an OFF file begins with OFF, or COFF, NOFF, STOFF or more such as STCNOFF";
    if (!lexer_.find_token()) fail(expected + "; this one is empty");
    keyword_ = lexer_.peek();
    const char* keyword_end = lexer_.position() + keyword_.size();
    std::string_view prefix = keyword_;
    if (!prefix.ends_with("OFF")) fail(expected + "; found " + in_quotes(keyword_));
    prefix.remove_suffix(3);
    const auto strip = [&](std::string_view word) {
      const bool is_there = prefix.starts_with(word);
      if (is_there) prefix.remove_prefix(word.size());
      return is_there;
    };
    if (strip("ST")) extra_numbers_ += 2;
    has_colour_ = strip("C");
    if (strip("N")) extra_numbers_ += 3;
    if (prefix == "4" || prefix == "n" || prefix == "4n") {
      fail(in_quotes(keyword_) + " has vertices in another space; only three coordinates are read");
    }
    if (!prefix.empty()) fail(expected + "; found " + in_quotes(keyword_));
    lexer_.advance(keyword_end);
    if (lexer_.has_token() && lexer_.peek() == "BINARY") {
      fail("binary OFF files are not read; store the mesh as text");
    }
  }

  // Vertices, faces and perhaps edges, whose count says nothing about the mesh and is often wrong.
  void read_counts() {
    if (!lexer_.find_token()) fail("the file ends before its counts of vertices and faces");
    vertices_ = read_count();
    faces_ = read_count();
    std::int64_t edges = 0;
    if (lexer_.has_token() && !lexer_.read(edges)) fail_at_token("a count of edges");
    end_row();
    if (vertices_ > builder_.limits().vertices) fail(too_many("vertices", builder_.limits().vertices));
    check_length();
  }

  std::uint64_t read_count() {
    const std::int64_t count = read_integer("the counts of vertices, faces and perhaps edges");
    if (count < 0) fail("the count " + std::to_string(count) + " is negative");
    return static_cast<std::uint64_t>(count);
  }

  // A number takes two bytes or more: what parts it from the one before, and a digit.
  void check_length() const {
    const std::uint64_t vertex_bytes = 2 * (3 + extra_numbers_ + (has_colour_ ? 3 : 0));
    const std::uint64_t face_bytes = 2 * 4;
    std::uint64_t left = lexer_.bytes_left();
    if (vertices_ > left / vertex_bytes) {
      fail(cut_short("the count of vertices", vertices_, vertex_bytes, left));
    }
    left -= vertices_ * vertex_bytes;
    if (faces_ > left / face_bytes) fail(cut_short("the count of faces", faces_, face_bytes, left));
  }

  void read_vertex() {
    begin_row();
    const float x = read_number();
    const float y = read_number();
    const float z = read_number();
    std::uint64_t extra = 0;
    for (; lexer_.has_token(); ++extra) read_number();
    const bool good =
        has_colour_ ? extra == extra_numbers_ + 3 || extra == extra_numbers_ + 4 : extra == extra_numbers_;
    if (!good) fail(wrong_extra(extra));
    builder_.add_vertex({x, y, z});
  }

  std::string wrong_extra(std::uint64_t found) const {
    std::string expected = std::to_string(extra_numbers_ + (has_colour_ ? 3 : 0));
    if (has_colour_) expected += " or " + std::to_string(extra_numbers_ + 4);
    return "a vertex of a file " + in_quotes(keyword_) + " has " + expected +
           " numbers after its coordinates, this one has " + std::to_string(found);
  }

  void read_face() {
    begin_row();
    const std::int64_t corners = read_integer("the number of a face's corners");
    if (corners < 0) fail("a face has the negative number of corners " + std::to_string(corners));
    if (corners < 3) fail(too_few_corners(static_cast<std::uint64_t>(corners)));
    builder_.begin_polygon();
    for (std::int64_t i = 0; i < corners; ++i) {
      const std::int64_t index = read_integer("a vertex index");
      if (index < 0 || static_cast<std::uint64_t>(index) >= vertices_) {
        fail(index_out_of_range(index, vertices_));
      }
      if (!builder_.add_corner(static_cast<std::uint32_t>(index))) {
        fail(too_many_triangles(builder_.limits()));
      }
    }
    pass_colour();
    builder_.end_polygon();
  }

  // Nothing, an entry of a colour map, or 3 or 4 components.
  void pass_colour() {
    std::uint64_t count = 0;
    for (; lexer_.has_token(); ++count) read_number();
    if (count == 2 || count > 4) {
      fail("a face's colour is 1, 3 or 4 numbers after its corners; found " + std::to_string(count));
    }
  }

  // The row's line stays the lexer's until the next row begins, so that errors name it.
  void begin_row() {
    lexer_.next_statement();
    if (!lexer_.find_token()) fail("the file ends here; it is cut short or its counts claim too much");
  }

  void end_row() {
    if (lexer_.has_token()) fail("the line goes on after its last value: " + in_quotes(lexer_.peek()));
  }

  float read_number() {
    float number = 0.0f;
    if (!lexer_.has_token() || !lexer_.read(number)) fail_at_token("a number");
    return number;
  }

  std::int64_t read_integer(const char* what) {
    std::int64_t integer = 0;
    if (!lexer_.has_token() || !lexer_.read(integer)) fail_at_token(what);
    return integer;
  }

  [[noreturn]] void fail_at_token(const std::string& expected) {
    fail("expected " + expected + ", found " +
         (lexer_.has_token() ? in_quotes(lexer_.peek()) : "the end of the line"));
  }

  const std::string& file_;
  Lexer<LexerSyntax{.comments = true}, Cursor> lexer_;
  MeshBuilder<Mesh>& builder_;
  std::string keyword_;
  std::uint64_t extra_numbers_ = 0;  // of a vertex after its coordinates, but for a colour
  bool has_colour_ = false;
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;
  const char* element_ = nullptr;
  std::uint64_t row_ = 0;
};

}  // namespace

TriangleMesh read_off(std::string_view text, const std::string& file, MeshReport& report,
                      const MeshLimits& limits) {
  MeshBuilder<WholeMesh> builder(limits);
  OffReader(WholeCursor(text), file, builder).read();
  report = builder.report();
  return builder.mesh().take();
}

MeshReport stream_off(const StreamJob& job) {
  MeshBuilder builder(job.limits, IndexedParts(job));
  OffReader(WindowCursor(job.window, 0), job.name, builder).read();
  builder.mesh().finish();
  return builder.report();
}

}  // namespace plumb::detail
