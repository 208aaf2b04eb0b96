// Numbers in messages: rounded to six digits, to the nearest or to a side that is safe to state.

#include <kaboum/base/number_text.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace kaboum {
namespace {

/// Moves x by steps smaller than what six digits resolve until its text is on the wanted side.
std::string rounded(double x, bool up) {
  const auto right = [&](const std::string& text) {
    const double value = std::strtod(text.c_str(), nullptr);
    return up ? value >= x : value <= x;
  };
  std::string text = number_text(x);
  const double step = (up ? 1e-6 : -1e-6) * std::abs(x);
  for (int i = 1; i < 20 && !right(text); ++i) text = number_text(x + i * step);
  return text;
}

}  // namespace

std::string number_text(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", x);
  return text.data();
}

std::string number_down(double x) { return rounded(x, false); }
std::string number_up(double x) { return rounded(x, true); }

}  // namespace kaboum
