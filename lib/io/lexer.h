#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "io/cursor.h"
#include "io/text.h"

namespace plumb::detail {

/// What a text format knows beside tokens and lines.
struct LexerSyntax {
  bool comments = false;       // from '#' to the line's end, whatever the line's last character
  bool continuations = false;  // a backslash at a line's end: the statement goes on in the next line
};

/// Walks over the statements of a text. A statement is a line, and a continuation separates tokens.
/// Lines end with LF, CR LF or CR. A byte order mark before the first is passed over. Pointers and views of
/// the text hold until the next call that is not const.
template <LexerSyntax kSyntax, class Cursor = WholeCursor>
class Lexer {
 public:
  explicit Lexer(Cursor cursor) : text_(std::move(cursor)) {
    text_.hold_word();
    if (std::string_view(text_.at, static_cast<std::size_t>(text_.end - text_.at))
            .starts_with("\xef\xbb\xbf"))
      text_.at += 3;
  }

  bool at_end() { return !more(); }
  std::size_t line() const { return line_; }
  const char* position() const { return text_.at; }
  const char* end() const { return text_.end; }
  std::uint64_t bytes_left() const { return text_.left(); }

  /// Passes over blanks and continuations; whether a token follows in this statement.
  bool has_token() {
    while (more()) {
      if (is_blank(*text_.at)) {
        ++text_.at;
      } else if (continues(text_.at)) {
        ++text_.at;
        pass_newline();
      } else {
        return !is_newline(*text_.at) && !is_comment(*text_.at);
      }
    }
    return false;
  }

  /// The token here, without passing it; only the beginning of one that is longer than a word may be.
  std::string_view peek() const {
    const char* token_end = text_.at;
    while (!ends_characters(token_end) && text_.is_word(token_end - text_.at)) ++token_end;
    return {text_.at, static_cast<std::size_t>(token_end - text_.at)};
  }

  /// Passes over the token here, whose end is known.
  void advance(const char* token_end) { text_.at = token_end; }

  /// Reads the token here, if all of it is a number, and passes it.
  bool read(float& number) { return pass(parse_float(text_.at, text_.end, number)); }
  bool read(std::int64_t& integer) { return pass(parse_integer(text_.at, text_.end, integer)); }

  /// Whether the token here ends before p.
  bool ends_token(const char* p) const { return text_.is_word(p - text_.at) && ends_characters(p); }

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
    while (more() && !is_newline(*text_.at)) ++text_.at;
    if (text_.at != text_.end) pass_newline();
  }

 private:
  // Whether the text goes on; then a word and what ends it are in memory.
  bool more() {
    text_.hold_word();
    return text_.at != text_.end;
  }

  bool pass(const char* token_end) {
    if (token_end == nullptr || !ends_token(token_end)) return false;
    advance(token_end);
    return true;
  }

  // Whether no character of a token is at p.
  bool ends_characters(const char* p) const {
    return p == text_.end || is_blank(*p) || is_newline(*p) || is_comment(*p) || continues(p);
  }

  static bool is_newline(char c) { return c == '\n' || c == '\r'; }
  static bool is_comment(char c) { return kSyntax.comments && c == '#'; }
  bool continues(const char* p) const {
    return kSyntax.continuations && *p == '\\' && p + 1 != text_.end && is_newline(p[1]);
  }

  void pass_newline() {
    text_.at += *text_.at == '\r' && text_.at + 1 != text_.end && text_.at[1] == '\n' ? 2 : 1;
    ++line_;
  }

  Cursor text_;
  std::size_t line_ = 1;
};

}  // namespace plumb::detail
