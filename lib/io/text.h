#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

// What the readers of mesh files share: numbers from text, and errors that name file, place and reason.

namespace plumb::detail {

/// Throws plumb::Error "file: place: reason".
[[noreturn]] void fail_in_file(const std::string& file, const std::string& place, const std::string& reason);

/// A piece of a file as it may stand in a message: in quotes, unprintable bytes as \xNN, cut when long.
std::string in_quotes(std::string_view text);

/// Reasons that more than one format has.
std::string too_few_corners(std::uint64_t corners);
std::string too_many(const char* what, std::uint64_t limit);
std::string index_out_of_range(std::int64_t index, std::uint64_t vertices);
std::string cut_short(const std::string& what, std::uint64_t claimed, std::uint64_t row_bytes,
                      std::uint64_t bytes_left);

inline bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

/// A longer number is taken for damage. (It also keeps every exponent far from where std::from_chars
/// of GCC 12 stops counting its digits.)
inline constexpr std::ptrdiff_t kMaxNumberLength = 4096;

/// Reads the decimal number, "nan" or "inf" at `begin`, rounded once to the nearest float, whatever
/// its size: 1e50 is infinite and 1e-50 is 0. A leading '+' is allowed. Returns the end of the number,
/// or nullptr where there is none. The caller checks what follows.
const char* parse_float(const char* begin, const char* end, float& value);

/// Reads the integer at `begin`, in decimal with an optional '-'. Returns its end, or nullptr where
/// there is none or it does not fit.
const char* parse_integer(const char* begin, const char* end, std::int64_t& value);

}  // namespace plumb::detail
