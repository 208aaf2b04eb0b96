// Lists of numbers in options.

#include <kaboum/base/parse_numbers.h>

#include <charconv>
#include <cmath>

namespace kaboum {

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> out;
  const char *at = text.data(), *end = at + text.size();
  while (at <= end) {
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value) || (stop != end && *stop != ','))
      return std::nullopt;
    out.push_back(value);
    at = stop + 1;
  }
  return out;
}

}  // namespace kaboum
