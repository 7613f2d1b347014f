// Blum: text files, read word by word. SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "blum/core/error.hpp"

namespace blum {

/// Returns text from a file in a short printable form, for messages.
inline std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += c >= ' ' && c <= '~' ? c : '?';
  return result + (text.size() > longest ? "...'" : "'");
}

/// Position in a text, with the basic steps of a parser. Lines may end in LF, CR LF or CR.
///
/// "Blanks" separate tokens within a line. "Space" means blanks, line ends and comments. Comments exist only in some
/// formats, and extend from the character `comment` to the end of the line. Lines are counted only for error messages.
class TextCursor {
 public:
  /// @param name     name of the file in messages. Name and text must outlive the cursor.
  /// @param comment  character that starts a comment between tokens; 0 if the format has none.
  /// @param continuation  character that joins a line with the next one if it is the line's last character; 0 if the
  /// format has none.
  TextCursor(std::string_view text, std::string_view name, char comment, char continuation = 0)
      : begin_(text.data()),
        position_(begin_),
        end_(begin_ + text.size()),
        name_(name),
        comment_(comment),
        continuation_(continuation) {
    if (text.starts_with("\xEF\xBB\xBF")) position_ += 3;  // a UTF-8 byte order mark
  }

  [[nodiscard]] static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  [[nodiscard]] static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }

  [[nodiscard]] bool at_end() const { return position_ == end_; }
  [[nodiscard]] std::size_t remaining() const { return static_cast<std::size_t>(end_ - position_); }
  [[nodiscard]] const char* position() const { return position_; }
  void set_position(const char* position) { position_ = position; }

  void skip_blanks() {
    while (position_ < end_) {
      if (is_blank(*position_)) {
        ++position_;
      } else if (continuation_ == 0 || *position_ != continuation_ || !skip_continuation()) {
        return;
      }
    }
  }

  /// Skips blanks. Returns true if the rest of this line is empty or a comment.
  bool at_line_end() {
    skip_blanks();
    return at_end() || is_line_end(*position_) || (comment_ != 0 && *position_ == comment_);
  }

  /// Moves behind the end of this line. Lines that are joined by a continuation count as one line.
  void skip_line() {
    for (; position_ < end_; ++position_) {
      if (is_line_end(*position_)) {
        ++position_;
        return;
      }
      if (continuation_ != 0 && *position_ == continuation_ && skip_continuation()) --position_;
    }
  }

  /// Moves to the next token, on this line or a later one. Returns false if there is none.
  bool skip_space() {
    while (at_line_end()) {
      if (at_end()) return false;
      skip_line();
    }
    return true;
  }

  /// Returns the token at the cursor, up to a blank or line end. It is empty at a line end. The cursor is not moved.
  [[nodiscard]] std::string_view peek_token() const {
    const char* last = position_;
    while (last < end_ && !is_blank(*last) && !is_line_end(*last)) ++last;
    return {position_, static_cast<std::size_t>(last - position_)};
  }

  /// Returns the token at the cursor and moves behind it.
  std::string_view take_token() {
    const std::string_view token = peek_token();
    position_ += token.size();
    return token;
  }

  /// Reads a finite number on this line. `what` is its description in messages.
  double take_number(std::string_view what) {
    skip_blanks();
    const char* const start = position_;
    const double value = take_number_here(what);
    if (!std::isfinite(value)) fail_at(start, std::string(what) + " is not finite: " + token_at(start));
    return value;
  }

  /// Reads a number on this line, which may be infinite or NaN.
  double take_any_number(std::string_view what) {
    skip_blanks();
    return take_number_here(what);
  }

  /// Reads an integer on this line. A blank or line end must follow it.
  std::int64_t take_integer(std::string_view what) {
    skip_blanks();
    const char* const start = position_;
    const std::int64_t value = take_integer_prefix(what);
    if (!ends_token(position_)) fail_at(start, not_what(start, what, "a whole number"));
    return value;
  }

  /// Reads an integer at the cursor. Any character may follow it.
  std::int64_t take_integer_prefix(std::string_view what) {
    const char* const start = position_;
    std::int64_t value = 0;
    const auto [last, error] = std::from_chars(skip_plus(start), end_, value);
    if (error == std::errc::result_out_of_range)
      fail_at(start, std::string(what) + " is too large: " + token_at(start));
    if (error != std::errc()) fail_at(start, not_what(start, what, "a whole number"));
    position_ = last;
    return value;
  }

  [[nodiscard]] std::size_t line_of(const char* where) const {
    std::size_t line = 1;
    for (const char* c = begin_; c < where; ++c) {
      line += *c == '\n' || (*c == '\r' && !(c + 1 < end_ && c[1] == '\n')) ? 1 : 0;
    }
    return line;
  }

  [[noreturn]] void fail(const std::string& message) const { fail_at(position_, message); }
  [[noreturn]] void fail_at(const char* where, const std::string& message) const {
    throw FormatError("'" + std::string(name_) + "', line " + std::to_string(line_of(where)) + ": " + message);
  }

 private:
  [[nodiscard]] bool ends_token(const char* c) const { return c == end_ || is_blank(*c) || is_line_end(*c); }
  [[nodiscard]] const char* skip_plus(const char* c) const {
    return c + 1 < end_ && *c == '+' && c[1] != '-' ? c + 1 : c;
  }

  /// Moves behind a continuation character and its line end. If no line end follows, returns false and does not move.
  bool skip_continuation() {
    const char* next = position_ + 1;
    if (next < end_ && *next == '\r') ++next;
    if (next < end_ && *next == '\n') {
      ++next;
    } else if (next == position_ + 1) {
      return false;
    }
    position_ = next;
    return true;
  }

  double take_number_here(std::string_view what) {
    const char* const start = position_;
    double value = 0;
    const auto [last, error] = std::from_chars(skip_plus(start), end_, value);
    if (error == std::errc::result_out_of_range) {
      value = tiny_or_fail(start, last, what);
    } else if (error != std::errc()) {
      fail_at(start, not_what(start, what, "a number"));
    }
    if (!ends_token(last)) fail_at(start, not_what(start, what, "a number"));
    position_ = last;
    return value;
  }

  /// Handles a number that from_chars rejects as out of range. Returns zero if it is too small for a double, and throws
  /// if it is too large.
  double tiny_or_fail(const char* start, const char* last, std::string_view what) const {
    std::string_view digits(start, static_cast<std::size_t>(last - start));
    const std::size_t mark = std::min(digits.find_first_of("eE"), digits.size());
    const bool small_exponent = mark + 1 < digits.size() && digits[mark + 1] == '-';
    // A number like 0.000...1 without an exponent is also small. One with many digits before the point is large.
    const std::size_t first = digits.find_first_of("123456789");
    const std::size_t point = std::min(digits.find('.'), mark);
    if (mark == digits.size() ? first > point : small_exponent) return digits.front() == '-' ? -0.0 : 0.0;
    fail_at(start, std::string(what) + " is too large for a double: " + token_at(start));
  }

  [[nodiscard]] std::string token_at(const char* start) const {
    TextCursor other = *this;
    other.position_ = start;
    return in_quotes(other.peek_token());
  }

  [[nodiscard]] std::string not_what(const char* start, std::string_view what, std::string_view kind) const {
    const std::string token = token_at(start);
    if (token != "''") return std::string(what) + " is not " + std::string(kind) + ": " + token;
    return std::string(what) + " is missing" + (start == end_ ? ": the file ends here" : "");
  }

  const char* begin_;
  const char* position_;
  const char* end_;
  std::string_view name_;
  char comment_;
  char continuation_;
};

}  // namespace blum

namespace blum::volume_io {

inline constexpr std::string_view white_space = " \t\r\n\v\f";

[[nodiscard]] inline std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(white_space);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(white_space) - first + 1);
}

[[nodiscard]] inline std::vector<std::string_view> split_words(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::size_t at = text.find_first_not_of(white_space); at != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(white_space, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = text.find_first_not_of(white_space, end);
  }
  return words;
}

[[nodiscard]] inline std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return out;
}

/// Parses a number that is the whole text. The text may start with a plus sign.
template <class T>
[[nodiscard]] std::optional<T> parse_number(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace blum::volume_io
