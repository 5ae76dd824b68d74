#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "io/lexer.h"
#include "io/mesh_builder.h"

namespace plumb::detail {

/// Whether the token is the keyword, in any case of letters.
inline bool is_keyword(std::string_view token, std::string_view keyword) {
  // No character but a letter becomes a small letter by that bit.
  return std::equal(token.begin(), token.end(), keyword.begin(), keyword.end(),
                    [](char c, char letter) { return (c | 0x20) == letter; });
}

/// Reads the text of an STL file into the builder. Keywords are in any case; line ends are blanks but after
/// "solid" and "endsolid", where a name may follow that ends with the line.
template <class Cursor, class Mesh>
class StlTextReader {
 public:
  StlTextReader(Cursor text, const std::string& file, MeshBuilder<Mesh>& builder)
      : lexer_(std::move(text)), file_(file), builder_(builder) {}

  /// Throws plumb::Error with the line at fault.
  void read() {
    do {
      read_solid();
    } while (lexer_.find_token());
  }

 private:
  [[noreturn]] void fail(const std::string& reason) const {
    fail_in_file(file_, "line " + std::to_string(lexer_.line()), reason);
  }

  [[noreturn]] void fail_at_token(const std::string& expected) {
    if (!lexer_.find_token()) fail("expected " + expected + ", but the file ends; it is cut short");
    fail("expected " + expected + ", found " + in_quotes(lexer_.peek()));
  }

  bool next_is(std::string_view keyword) { return lexer_.find_token() && is_keyword(lexer_.peek(), keyword); }

  void pass(std::string_view keyword) {
    if (!next_is(keyword)) fail_at_token(in_quotes(keyword));
    lexer_.advance(lexer_.position() + keyword.size());
  }

  void read_solid() {
    pass("solid");
    lexer_.next_statement();  // the name
    while (next_is("facet")) read_facet();
    if (!next_is("endsolid")) fail_at_token("\"facet\" or \"endsolid\"");
    lexer_.next_statement();
  }

  void read_facet() {
    pass("facet");
    pass("normal");
    read_point();
    pass("outer");
    pass("loop");
    add_triangle();
    pass("endloop");
    pass("endfacet");
  }

  void add_triangle() {
    const std::uint64_t vertices = builder_.vertices();
    builder_.begin_polygon();
    for (std::uint64_t i = 0; i < 3; ++i) {
      pass("vertex");
      const glm::vec3 point = read_point();
      if (vertices + i >= builder_.limits().vertices) fail(too_many("vertices", builder_.limits().vertices));
      builder_.add_vertex(point);
      if (!builder_.add_corner(static_cast<std::uint32_t>(vertices + i))) {
        fail(too_many_triangles(builder_.limits()));
      }
    }
    builder_.end_polygon();
  }

  glm::vec3 read_point() {
    const float x = read_number();
    const float y = read_number();
    const float z = read_number();
    return {x, y, z};
  }

  float read_number() {
    float number = 0.0f;
    if (!lexer_.find_token() || !lexer_.read(number)) fail_at_token("a number");
    return number;
  }

  Lexer<LexerSyntax{}, Cursor> lexer_;
  const std::string& file_;
  MeshBuilder<Mesh>& builder_;
};

/// Whether the first word of the bytes is "solid", in any case.
template <class Cursor>
bool begins_with_solid(Cursor text) {
  Lexer<LexerSyntax{}, Cursor> lexer(std::move(text));
  return lexer.find_token() && is_keyword(lexer.peek(), "solid");
}

}  // namespace plumb::detail
