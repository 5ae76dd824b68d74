#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "io/cursor.h"
#include "io/ply_header.h"
#include "io/text.h"

namespace plumb::detail {

/// The values of a text PLY body: one row of an element is one line. Blank lines are passed over.
/// PlyBinarySource has the same interface.
template <class Cursor>
class PlyAsciiSource {
 public:
  /// The cursor is at the body's beginning.
  PlyAsciiSource(Cursor body, const PlyHeader& header, const std::string& file)
      : text_(std::move(body)), line_(header.lines + 1), file_(file) {}

  void begin_row(const PlyElement& element, std::uint64_t row) {
    element_ = &element;
    row_ = row;
    while (at_line_end()) {
      if (text_.at == text_.end) fail("the file ends here; it is cut short or the header claims too much");
      ++text_.at;
      ++line_;
    }
  }

  void end_row() {
    if (!at_line_end()) fail("the line goes on after its last value: " + in_quotes(token()));
  }

  /// The next value, rounded once to the nearest float.
  float real(const PlyProperty& property) {
    if (!is_real(property.type)) return static_cast<float>(integer(property.type, property));
    begin_value(property);
    float value = 0.0f;
    end_value(parse_float(text_.at, text_.end, value), property.type, property);
    return value;
  }

  /// The next value, of an integer type: of the property's entries or of its list's length.
  std::int64_t integer(PlyType type, const PlyProperty& property) {
    begin_value(property);
    std::int64_t value = 0;
    const char* value_end = parse_integer(text_.at, text_.end, value);
    if (!holds(type, value)) value_end = nullptr;
    end_value(value_end, type, property);
    return value;
  }

  /// Gives the next `count` entries, of an integer type, to `take`.
  template <typename Take>
  void integers(std::uint64_t count, const PlyProperty& property, const Take& take) {
    for (std::uint64_t i = 0; i < count; ++i) take(integer(property.type, property));
  }

  /// A text has no rows that can be read faster.
  template <typename Take>
  std::uint64_t plain_triangles(const PlyElement&, std::uint64_t, std::uint64_t, const Take&) {
    return 0;
  }

  /// Passes over `count` values, which must be of their type all the same.
  void skip(std::uint64_t count, const PlyProperty& property);

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  // A carriage return is blank here: it belongs to the line feed after it.
  static bool separates(char c) { return is_blank(c) || c == '\r' || c == '\n'; }

  // Whether the text goes on; then a word and what ends it are in memory.
  bool more() {
    text_.hold_word();
    return text_.at != text_.end;
  }

  // Passes over blanks; whether the line, and perhaps the file, ends there.
  bool at_line_end() {
    while (more() && *text_.at != '\n' && separates(*text_.at)) ++text_.at;
    return text_.at == text_.end || *text_.at == '\n';
  }

  void begin_value(const PlyProperty& property) {
    if (at_line_end()) fail_at_line_end(property);
  }

  void end_value(const char* value_end, PlyType type, const PlyProperty& property) {
    if (value_end == nullptr || !ends_value(value_end)) fail_at_value(type, property);
    text_.at = value_end;
  }

  // Whether the value here ends before p.
  bool ends_value(const char* p) const {
    return text_.is_word(p - text_.at) && (p == text_.end || separates(*p));
  }

  static bool holds(PlyType type, std::int64_t value);
  std::string_view token() const;
  [[noreturn]] void fail_at_line_end(const PlyProperty& property) const;
  [[noreturn]] void fail_at_value(PlyType type, const PlyProperty& property) const;

  Cursor text_;
  std::size_t line_;
  const std::string& file_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

extern template class PlyAsciiSource<WholeCursor>;
extern template class PlyAsciiSource<WindowCursor>;

}  // namespace plumb::detail
