// Words and numbers of text formats.
#include "text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace kaboum::io {
namespace {

/// Whether a number that std::from_chars calls out of range is too small rather than too large:
/// from_chars does not say. Looks at the place of the first significant digit.
bool underflows(std::string_view digits) {
  if (digits.starts_with('-')) digits.remove_prefix(1);
  const std::size_t e = std::min(digits.find_first_of("eE"), digits.size());
  const std::string_view mantissa = digits.substr(0, e);
  const std::size_t significant = mantissa.find_first_of("123456789");
  if (significant == std::string_view::npos) return true;
  const std::size_t point = std::min(mantissa.find('.'), mantissa.size());
  if (e == digits.size()) return point < significant;
  std::string_view power = digits.substr(e + 1);
  if (power.starts_with('+')) power.remove_prefix(1);
  std::int64_t exponent = 0;
  if (std::from_chars(power.data(), power.data() + power.size(), exponent).ec != std::errc())
    return power.starts_with('-');
  const double order = static_cast<double>(point) - static_cast<double>(significant);
  return static_cast<double>(exponent) + order < 0;
}

}  // namespace

std::optional<double> to_double(std::string_view token) {
  if (token.starts_with('+') && !token.starts_with("+-")) token.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (end != token.data() + token.size() || error == std::errc::invalid_argument)
    return std::nullopt;
  if (error == std::errc::result_out_of_range) return underflows(token) ? 0.0 : HUGE_VAL;
  return value;
}

double parse_coordinate(const Source& source, std::string_view token) {
  const std::optional<double> value = to_double(token);
  if (!value)
    fail(source, token.data(),
         in_quotes(token) +
             " is not a number; check that the file is complete and uses a decimal point");
  if (!std::isfinite(*value))
    fail(source, token.data(),
         "the coordinate " + in_quotes(token) +
             " is not a finite double; remove or repair this vertex");
  return *value;
}

std::int64_t parse_integer(const Source& source, std::string_view token, std::string_view what) {
  std::string_view digits = token;
  if (digits.starts_with('+') && !digits.starts_with("+-")) digits.remove_prefix(1);
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (end != digits.data() + digits.size() || error != std::errc())
    fail(source, token.data(),
         in_quotes(token) + " is not an integer where " + std::string(what) +
             " is expected; the file is damaged or of another format");
  return value;
}

std::string shortest_digits(double x) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), x);
  return {text.data(), end};
}

bool same_word(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return lower(x) == lower(y); });
}

bool starts_with_word(std::string_view text, std::string_view word) {
  return text.size() >= word.size() && same_word(text.substr(0, word.size()), word);
}

std::string_view without_byte_order_mark(std::string_view bytes) {
  if (bytes.starts_with("\xEF\xBB\xBF")) bytes.remove_prefix(3);
  return bytes;
}

std::string_view Scanner::need(std::string_view what) {
  const std::string_view found = token();
  if (found.empty())
    fail(
        source_, source_.end(),
        "the file ends where " + std::string(what) + " is expected; it is truncated, get it again");
  return found;
}

void Scanner::skip_line() {
  while (at_ != source_.end()) {
    if (at_joint()) {
      skip_joint();
    } else if (detail::char_class(*at_++) == detail::kEol) {
      return;
    }
  }
}

bool Scanner::skip_to_next_line() {
  while (at_ != source_.end()) {
    if (at_joint()) {
      skip_joint();
      return true;
    }
    if (detail::char_class(*at_++) == detail::kEol) return false;
  }
  return false;
}

}  // namespace kaboum::io
