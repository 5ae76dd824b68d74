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

}  // namespace

template <class Cursor>
bool PlyAsciiSource<Cursor>::holds(PlyType type, std::int64_t value) {
  const Range range = kRanges[static_cast<std::size_t>(type)];
  return value >= range.least && value <= range.greatest;
}

template <class Cursor>
std::string_view PlyAsciiSource<Cursor>::token() const {
  const char* token_end = text_.at;
  while (token_end != text_.end && !separates(*token_end) && text_.is_word(token_end - text_.at)) ++token_end;
  return {text_.at, static_cast<std::size_t>(token_end - text_.at)};
}

template <class Cursor>
void PlyAsciiSource<Cursor>::fail_at_line_end(const PlyProperty& property) const {
  fail("the line ends where a value of property " + in_quotes(property.name) + " should be");
}

template <class Cursor>
void PlyAsciiSource<Cursor>::fail_at_value(PlyType type, const PlyProperty& property) const {
  fail("property " + in_quotes(property.name) + ": expected a value of type " + name_of(type) + ", found " +
       in_quotes(token()));
}

template <class Cursor>
void PlyAsciiSource<Cursor>::skip(std::uint64_t count, const PlyProperty& property) {
  for (std::uint64_t i = 0; i < count; ++i) {
    if (is_real(property.type)) {
      real(property);
    } else {
      integer(property.type, property);
    }
  }
}

template <class Cursor>
void PlyAsciiSource<Cursor>::fail(const std::string& reason) const {
  fail_in_file(file_,
               "line " + std::to_string(line_) + " (" + element_->name + " " + std::to_string(row_) + ")",
               reason);
}

template class PlyAsciiSource<WholeCursor>;
template class PlyAsciiSource<WindowCursor>;

}  // namespace plumb::detail
