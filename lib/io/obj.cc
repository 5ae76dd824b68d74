#include "io/obj.h"

#include <algorithm>
#include <array>
#include <utility>

#include "io/lexer.h"
#include "io/mesh_parts.h"
#include "io/text.h"

// The format: Wavefront Technologies, "Advanced Visualizer Manual", appendix B1, "Object Files".

namespace plumb::detail {
namespace {

// Statements that say nothing about where a polygon is.
constexpr std::array<std::string_view, 20> kPassedOver = {
    "vt",     "vn",       "vp",    "g",        "o",   "s", "mg", "usemtl",     "mtllib",    "usemap",
    "maplib", "c_interp", "bevel", "d_interp", "lod", "l", "p",  "shadow_obj", "trace_obj", "ctech"};

template <class Cursor, class Mesh>
class ObjReader {
 public:
  ObjReader(Cursor text, const std::string& file, MeshBuilder<Mesh>& builder)
      : lexer_(std::move(text)), file_(file), builder_(builder) {}

  void read() {
    for (; !lexer_.at_end(); lexer_.next_statement()) {
      if (lexer_.has_token()) read_statement();
    }
    if (forward_index_ > builder_.vertices()) {
      fail_at(forward_line_, "the face refers to vertex " + std::to_string(forward_index_) +
                                 ", but the file has only " + std::to_string(builder_.vertices()));
    }
  }

 private:
  [[noreturn]] void fail_at(std::size_t line, const std::string& reason) const {
    fail_in_file(file_, "line " + std::to_string(line), reason);
  }
  [[noreturn]] void fail(const std::string& reason) const { fail_at(lexer_.line(), reason); }

  void read_statement() {
    const std::string_view keyword = lexer_.peek();
    if (keyword == "v" || keyword == "f") {
      lexer_.advance(keyword.data() + keyword.size());
      return keyword == "v" ? read_vertex() : read_face();
    }
    if (std::find(kPassedOver.begin(), kPassedOver.end(), keyword) == kPassedOver.end()) {
      fail("unknown statement " + in_quotes(keyword) + "; only polygons (v, f) are read");
    }
  }

  // Three coordinates; a weight, a colour or both may follow.
  void read_vertex() {
    constexpr std::size_t kMost = 7;
    std::array<float, kMost> numbers{};
    std::size_t count = 0;
    for (; lexer_.has_token(); ++count) {
      const float number = read_number();
      if (count < kMost) numbers[count] = number;
    }
    if (count != 3 && count != 4 && count != 6 && count != 7) {
      fail("a vertex has 3 coordinates, then perhaps a weight, a colour of 3 numbers or both; found " +
           std::to_string(count) + " numbers");
    }
    if (builder_.vertices() >= builder_.limits().vertices) {
      fail(too_many("vertices", builder_.limits().vertices));
    }
    builder_.add_vertex({numbers[0], numbers[1], numbers[2]});
  }

  float read_number() {
    float number = 0.0f;
    if (!lexer_.read(number)) fail("expected a number, found " + in_quotes(lexer_.peek()));
    return number;
  }

  void read_face() {
    const std::size_t line = lexer_.line();
    builder_.begin_polygon();
    while (lexer_.has_token()) {
      if (!builder_.add_corner(read_corner())) {
        fail(too_many_triangles(builder_.limits()));
      }
    }
    if (builder_.corners() < 3) fail_at(line, too_few_corners(builder_.corners()));
    builder_.end_polygon();
  }

  // v, v/vt, v//vn or v/vt/vn; of these only v matters.
  std::uint32_t read_corner() {
    std::int64_t vertex = 0;
    std::int64_t other = 0;
    const char* end = parse_integer(lexer_.position(), lexer_.end(), vertex);
    const auto follows = [&](char c) { return end != nullptr && end != lexer_.end() && *end == c; };
    if (follows('/')) {
      ++end;
      if (!follows('/')) end = parse_integer(end, lexer_.end(), other);
      if (follows('/')) end = parse_integer(end + 1, lexer_.end(), other);
    }
    if (end == nullptr || !lexer_.ends_token(end)) {
      fail("expected a corner v, v/vt, v//vn or v/vt/vn of integers, found " + in_quotes(lexer_.peek()));
    }
    const std::uint32_t index = to_index(vertex);
    lexer_.advance(end);
    return index;
  }

  std::uint32_t to_index(std::int64_t vertex) {
    const auto seen = static_cast<std::int64_t>(builder_.vertices());
    if (vertex == 0) fail("vertex index 0; indices begin at 1");
    if (vertex < 0) {
      if (vertex < -seen) {
        fail("vertex index " + std::to_string(vertex) + " is out of range; " + std::to_string(seen) +
             " vertices come before the face");
      }
      return static_cast<std::uint32_t>(seen + vertex);
    }
    if (static_cast<std::uint64_t>(vertex) > builder_.limits().vertices) {
      fail("vertex index " + std::to_string(vertex) + " is out of range");
    }
    // Whether a later vertex exists is known at the end: the greatest such index decides for all.
    if (vertex > seen && static_cast<std::uint64_t>(vertex) > forward_index_) {
      forward_index_ = static_cast<std::uint64_t>(vertex);
      forward_line_ = lexer_.line();
    }
    return static_cast<std::uint32_t>(vertex - 1);
  }

  Lexer<LexerSyntax{.comments = true, .continuations = true}, Cursor> lexer_;
  const std::string& file_;
  MeshBuilder<Mesh>& builder_;
  std::uint64_t forward_index_ = 0;
  std::size_t forward_line_ = 0;
};

}  // namespace

TriangleMesh read_obj(std::string_view text, const std::string& file, MeshReport& report,
                      const MeshLimits& limits) {
  MeshBuilder<WholeMesh> builder(limits);
  ObjReader(WholeCursor(text), file, builder).read();
  report = builder.report();
  return builder.mesh().take();
}

MeshReport stream_obj(const StreamJob& job) {
  MeshBuilder builder(job.limits, IndexedParts(job));
  ObjReader(WindowCursor(job.window, 0), job.name, builder).read();
  builder.mesh().finish();
  return builder.report();
}

}  // namespace plumb::detail
