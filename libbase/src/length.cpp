// Lengths in words.

#include <kaboum/base/length.h>

#include <array>
#include <charconv>

namespace kaboum {

std::string Length::text() const {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  return std::string(digits.data(), end) + (percent ? "%" : "");
}

}  // namespace kaboum
