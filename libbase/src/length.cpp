// Lengths in words.

#include <kaboum/base/length.h>
#include <kaboum/base/parse_length.h>

#include <array>
#include <charconv>
#include <cmath>

namespace kaboum {

std::string Length::text() const {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return std::string(digits.data(), end) + (percent ? "%" : "");
}

std::optional<Length> parse_length(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Length length;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, length.value);
  if (error != std::errc() || !std::isfinite(length.value) || !(length.value > 0))
    return std::nullopt;
  length.percent = stop != end && *stop == '%';
  if (stop + (length.percent ? 1 : 0) != end) return std::nullopt;
  return length;
}

}  // namespace kaboum
