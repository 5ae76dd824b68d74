#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

// What the readers of mesh files share: numbers from text, and errors that name file and place.

namespace plumb::detail {

/// Throws plumb::Error "file: place: reason".
[[noreturn]] void fail_in_file(const std::string& file, const std::string& place, const std::string& reason);

/// A piece of a file as it may stand in a message: in quotes, unprintable bytes as \xNN, cut when long.
std::string in_quotes(std::string_view text);

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
