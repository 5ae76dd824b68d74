#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/ply_header.h"

namespace plumb::detail {

/// The values of a text PLY body: one row of an element is one line. Blank lines are passed over.
/// PlyBinarySource has the same interface.
class PlyAsciiSource {
 public:
  PlyAsciiSource(std::string_view bytes, const PlyHeader& header, const std::string& file)
      : at_(bytes.data() + header.bytes),
        end_(bytes.data() + bytes.size()),
        line_(header.lines + 1),
        file_(file) {}

  void begin_row(const PlyElement& element, std::uint64_t row);
  void end_row();

  /// The next value, rounded once to the nearest float.
  float real(const PlyProperty& property);

  /// The next value, of an integer type: of the property's entries or of its list's length.
  std::int64_t integer(PlyType type, const PlyProperty& property);

  /// Passes over `count` values, which must be of their type all the same.
  void skip(std::uint64_t count, const PlyProperty& property);

  [[noreturn]] void fail(const std::string& reason) const;

 private:
  bool at_line_end();
  void begin_value(const PlyProperty& property);
  void end_value(const char* value_end, PlyType type, const PlyProperty& property);
  std::string_view token() const;

  const char* at_;
  const char* end_;
  std::size_t line_;
  const std::string& file_;
  const PlyElement* element_ = nullptr;
  std::uint64_t row_ = 0;
};

}  // namespace plumb::detail
