#include "io/text.h"

#include <charconv>
#include <limits>
#include <system_error>

#include "plumb/error.h"

namespace plumb::detail {
namespace {

// The power of ten just above the number in [begin, end), which is not zero: 3 for 123.4, -2 for 0.001.
int decimal_magnitude(const char* begin, const char* end) {
  int magnitude = 0;
  bool point = false;
  bool significant = false;
  const char* p = begin;
  for (; p != end && *p != 'e' && *p != 'E'; ++p) {
    if (*p == '.') {
      point = true;
      continue;
    }
    significant = significant || *p != '0';
    if (significant && !point) ++magnitude;
    if (!significant && point) --magnitude;
  }
  if (p == end) return magnitude;
  const char* exponent_begin = p + 1;
  if (exponent_begin != end && *exponent_begin == '+') ++exponent_begin;
  int exponent = 0;
  if (std::from_chars(exponent_begin, end, exponent).ec == std::errc::result_out_of_range) {
    exponent = std::numeric_limits<int>::max() / (*exponent_begin == '-' ? -2 : 2);
  }
  return magnitude + exponent;
}

}  // namespace

void fail_in_file(const std::string& file, const std::string& place, const std::string& reason) {
  throw Error(file + ": " + place + ": " + reason);
}

std::string too_few_corners(std::uint64_t corners) {
  return "a face needs 3 corners or more, this one has " + std::to_string(corners);
}

std::string too_many(const char* what, std::uint64_t limit) {
  return "more than " + std::to_string(limit) + " " + what + "; split the mesh";
}

std::string index_out_of_range(std::int64_t index, std::uint64_t vertices) {
  return "vertex index " + std::to_string(index) + " is out of range; there are " + std::to_string(vertices) +
         " vertices";
}

std::string cut_short(const std::string& what, std::uint64_t claimed, std::uint64_t row_bytes,
                      std::uint64_t bytes_left) {
  return what + " claims " + std::to_string(claimed) + " rows of at least " + std::to_string(row_bytes) +
         " bytes, but only " + std::to_string(bytes_left) + " bytes are left for it; the file is cut short";
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t kMaxShown = 40;
  constexpr char kHex[] = "0123456789abcdef";
  std::string result = "\"";
  for (const char c : text.substr(0, kMaxShown)) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7f) {
      result += c;
    } else {
      result += "\\x";
      result += kHex[byte >> 4];
      result += kHex[byte & 15];
    }
  }
  return result + (text.size() > kMaxShown ? "...\"" : "\"");
}

const char* parse_float(const char* begin, const char* end, float& value) {
  if (begin != end && *begin == '+') {
    ++begin;
    if (begin != end && *begin == '-') return nullptr;
  }
  const std::from_chars_result result = std::from_chars(begin, end, value);
  if (result.ptr - begin > kMaxNumberLength) return nullptr;
  if (result.ec == std::errc()) return result.ptr;
  if (result.ec != std::errc::result_out_of_range) return nullptr;
  // What is out of range rounds to infinity or to zero, and from_chars does not say to which.
  const bool negative = *begin == '-';
  const bool huge = decimal_magnitude(begin + (negative ? 1 : 0), result.ptr) > 0;
  value = huge ? std::numeric_limits<float>::infinity() : 0.0f;
  if (negative) value = -value;
  return result.ptr;
}

const char* parse_integer(const char* begin, const char* end, std::int64_t& value) {
  const std::from_chars_result result = std::from_chars(begin, end, value);
  return result.ec == std::errc() ? result.ptr : nullptr;
}

}  // namespace plumb::detail
