#include "io/ply_ascii.h"

#include <array>
#include <limits>

#include "io/text.h"

namespace plumb::detail {
namespace {

struct Range {
  std::int64_t least, greatest;
};

template <typename T>
constexpr Range range_of() {
  return {std::numeric_limits<T>::min(), std::numeric_limits<T>::max()};
}

// In the order of PlyType.
constexpr std::array<Range, 6> kRanges = {range_of<std::int8_t>(),  range_of<std::uint8_t>(),
                                          range_of<std::int16_t>(), range_of<std::uint16_t>(),
                                          range_of<std::int32_t>(), range_of<std::uint32_t>()};

// A carriage return is blank here: it belongs to the line feed after it.
bool separates(char c) { return is_blank(c) || c == '\r' || c == '\n'; }

}  // namespace

void PlyAsciiSource::begin_row(const PlyElement& element, std::uint64_t row) {
  element_ = &element;
  row_ = row;
  while (at_line_end()) {
    if (at_ == end_) fail("the file ends here; it is cut short or the header claims too much");
    ++at_;
    ++line_;
  }
}

void PlyAsciiSource::end_row() {
  if (!at_line_end()) fail("the line goes on after its last value: " + in_quotes(token()));
}

// Passes over blanks; whether the line, and perhaps the file, ends there.
bool PlyAsciiSource::at_line_end() {
  while (at_ != end_ && *at_ != '\n' && separates(*at_)) ++at_;
  return at_ == end_ || *at_ == '\n';
}

std::string_view PlyAsciiSource::token() const {
  const char* token_end = at_;
  while (token_end != end_ && !separates(*token_end)) ++token_end;
  return {at_, static_cast<std::size_t>(token_end - at_)};
}

void PlyAsciiSource::begin_value(const PlyProperty& property) {
  if (at_line_end()) {
    fail("the line ends where a value of property " + in_quotes(property.name) + " should be");
  }
}

void PlyAsciiSource::end_value(const char* value_end, PlyType type, const PlyProperty& property) {
  if (value_end == nullptr || (value_end != end_ && !separates(*value_end))) {
    fail("property " + in_quotes(property.name) + ": expected a value of type " + name_of(type) + ", found " +
         in_quotes(token()));
  }
  at_ = value_end;
}

float PlyAsciiSource::real(const PlyProperty& property) {
  if (!is_real(property.type)) return static_cast<float>(integer(property.type, property));
  begin_value(property);
  float value = 0.0f;
  end_value(parse_float(at_, end_, value), property.type, property);
  return value;
}

std::int64_t PlyAsciiSource::integer(PlyType type, const PlyProperty& property) {
  begin_value(property);
  std::int64_t value = 0;
  const char* value_end = parse_integer(at_, end_, value);
  const Range range = kRanges[static_cast<std::size_t>(type)];
  if (value < range.least || value > range.greatest) value_end = nullptr;
  end_value(value_end, type, property);
  return value;
}

void PlyAsciiSource::skip(std::uint64_t count, const PlyProperty& property) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (is_real(property.type)) {
      real(property);
    } else {
      integer(property.type, property);
    }
  }
}

void PlyAsciiSource::fail(const std::string& reason) const {
  fail_in_file(file_,
               "line " + std::to_string(line_) + " (" + element_->name + " " + std::to_string(row_) + ")",
               reason);
}

}  // namespace plumb::detail
