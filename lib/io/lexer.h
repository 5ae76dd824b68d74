#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "io/text.h"

namespace plumb::detail {

/// What a text format knows beside tokens and lines.
struct LexerSyntax {
  bool comments = false;       // from '#' to the line's end, whatever the line's last character
  bool continuations = false;  // a backslash at a line's end: the statement goes on in the next line
};

/// Walks over the statements of a text. A statement is a line, and a continuation separates tokens.
/// Lines end with LF, CR LF or CR. A byte order mark before the first is passed over.
template <LexerSyntax kSyntax>
class Lexer {
 public:
  explicit Lexer(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {
    if (text.starts_with("\xef\xbb\xbf")) at_ += 3;
  }

  bool at_end() const { return at_ == end_; }
  std::size_t line() const { return line_; }
  const char* position() const { return at_; }
  const char* end() const { return end_; }

  /// Passes over blanks and continuations; whether a token follows in this statement.
  bool has_token() {
    while (at_ != end_) {
      if (is_blank(*at_)) {
        ++at_;
      } else if (continues(at_)) {
        ++at_;
        pass_newline();
      } else {
        return !is_newline(*at_) && !is_comment(*at_);
      }
    }
    return false;
  }

  /// The token here, without passing it.
  std::string_view peek() const {
    const char* token_end = at_;
    while (!ends_token(token_end)) ++token_end;
    return {at_, static_cast<std::size_t>(token_end - at_)};
  }

  /// Passes over the token here, whose end is known.
  void advance(const char* token_end) { at_ = token_end; }

  /// Reads the token here, if all of it is a number, and passes it.
  bool read(float& number) { return pass(parse_float(at_, end_, number)); }
  bool read(std::int64_t& integer) { return pass(parse_integer(at_, end_, integer)); }

  /// Whether no character of a token is at p.
  bool ends_token(const char* p) const {
    return p == end_ || is_blank(*p) || is_newline(*p) || is_comment(*p) || continues(p);
  }

  /// Passes over line ends and comments to the next token, perhaps lines away; whether there is one.
  bool find_token() {
    while (!has_token()) {
      if (at_end()) return false;
      next_statement();
    }
    return true;
  }

  /// Passes over the rest of the statement, a comment and the line's end.
  void next_statement() {
    while (has_token()) advance(peek().data() + peek().size());
    while (at_ != end_ && !is_newline(*at_)) ++at_;
    if (at_ != end_) pass_newline();
  }

 private:
  bool pass(const char* token_end) {
    if (token_end == nullptr || !ends_token(token_end)) return false;
    advance(token_end);
    return true;
  }

  static bool is_newline(char c) { return c == '\n' || c == '\r'; }
  static bool is_comment(char c) { return kSyntax.comments && c == '#'; }
  bool continues(const char* p) const {
    return kSyntax.continuations && *p == '\\' && p + 1 != end_ && is_newline(p[1]);
  }

  void pass_newline() {
    at_ += *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n' ? 2 : 1;
    ++line_;
  }

  const char* at_;
  const char* end_;
  std::size_t line_ = 1;
};

}  // namespace plumb::detail
