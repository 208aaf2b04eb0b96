#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "source.h"

namespace kaboum::io {

namespace detail {
enum CharClass : unsigned char { kOther = 0, kBlank = 1, kEol = 2 };
inline constexpr std::array<unsigned char, 256> kCharClass = [] {
  std::array<unsigned char, 256> table{};
  table[' '] = table['\t'] = table['\v'] = table['\f'] = kBlank;
  table['\n'] = table['\r'] = kEol;
  return table;
}();
inline unsigned char char_class(char c) { return kCharClass[static_cast<unsigned char>(c)]; }
}  // namespace detail

/// The double nearest to the number in `token`, which may begin with '+': infinite when it
/// overflows; nullopt when the token is not a number.
std::optional<double> to_double(std::string_view token);

/// The double nearest to the number in `token`; underflow gives the nearest subnormal or zero.
/// Accepts a leading '+'. Fails when the token is not a number, overflows, or is not finite.
double parse_coordinate(const Source& source, std::string_view token);

/// Integer in `token`, wholly. `what` names it in the message.
std::int64_t parse_integer(const Source& source, std::string_view token, std::string_view what);

/// The fewest digits that give the double back.
std::string shortest_digits(double x);

/// True when both are the same up to ASCII case.
bool same_word(std::string_view a, std::string_view b);
/// True when `text` begins with `word`, up to ASCII case.
bool starts_with_word(std::string_view text, std::string_view word);

/// Bytes without a leading UTF-8 byte order mark.
std::string_view without_byte_order_mark(std::string_view bytes);

/// Splits text into tokens between white space, with `#` comments; never copies.
class Scanner {
 public:
  struct Syntax {
    bool comments = false;      ///< '#' at the start of a token begins a comment
    bool continuation = false;  ///< a backslash before the line end joins two lines
  };

  Scanner(const Source& source, Syntax syntax)
      : source_(source), syntax_(syntax), at_(without_byte_order_mark(source.bytes).data()) {}

  /// Next token of the current line; empty at its end.
  std::string_view token_on_line() {
    skip_blanks();
    const char* const first = at_;
    while (at_ != source_.end() && detail::char_class(*at_) == detail::kOther && !at_joint()) ++at_;
    last_ = first;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  /// Next token, across lines; empty at the end of the file.
  std::string_view token() {
    for (;;) {
      const std::string_view found = token_on_line();
      if (!found.empty() || at_ == source_.end()) return found;
      ++at_;
    }
  }

  /// Next token; fails, naming `what` was expected, at the end of the file.
  std::string_view need(std::string_view what);

  double coordinate() { return parse_coordinate(source_, need("a coordinate")); }
  std::int64_t integer(std::string_view what) { return parse_integer(source_, need(what), what); }

  /// Moves to the start of the next line.
  void skip_line();
  /// The same, also past a backslash that joins this line with the next. @return whether there was
  /// one
  bool skip_to_next_line();

  void seek(const char* position) { at_ = last_ = position; }
  [[nodiscard]] bool done() const { return at_ == source_.end(); }
  /// Start of the latest token.
  [[nodiscard]] const char* last() const { return last_; }
  [[nodiscard]] const char* position() const { return at_; }
  [[nodiscard]] std::size_t bytes_left() const {
    return static_cast<std::size_t>(source_.end() - at_);
  }

 private:
  /// At a backslash that joins this line with the next.
  [[nodiscard]] bool at_joint() const {
    return syntax_.continuation && *at_ == '\\' && at_ + 1 != source_.end() &&
           detail::char_class(at_[1]) == detail::kEol;
  }
  void skip_joint() { at_ += at_[1] == '\r' && at_ + 2 != source_.end() && at_[2] == '\n' ? 3 : 2; }
  void skip_blanks() {
    while (at_ != source_.end()) {
      if (detail::char_class(*at_) == detail::kBlank) {
        ++at_;
      } else if (at_joint()) {
        skip_joint();
      } else if (syntax_.comments && *at_ == '#') {
        while (at_ != source_.end() && detail::char_class(*at_) != detail::kEol) ++at_;
      } else {
        return;
      }
    }
  }

  const Source& source_;
  Syntax syntax_;
  const char* at_;
  const char* last_ = at_;
};

}  // namespace kaboum::io
