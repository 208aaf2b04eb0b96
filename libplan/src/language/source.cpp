// Messages about a location in a text: file, line, column, and a caret below the line.
#include "language/source.h"

#include <algorithm>

namespace kaboum::plan {

std::string Source::diagnostic(std::size_t offset, std::string_view message) const {
  offset = std::min(offset, text.size());
  const std::size_t newline = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
  const std::size_t begin = newline == std::string::npos ? 0 : newline + 1;
  const std::size_t end = std::min(text.find('\n', begin), text.size());
  const auto line =
      1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(begin), '\n');

  // Shown are at most kWidth bytes around the place; bytes that a terminal might obey become '?'.
  constexpr std::size_t kWidth = 120;
  const std::size_t from = offset - begin > kWidth / 2 ? offset - kWidth / 2 : begin;
  std::string shown(text, from, std::min(end - from, kWidth));
  std::string caret;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const auto c = static_cast<unsigned char>(shown[i]);
    if (c == '\t') {
      shown[i] = ' ';
    } else if (c < 0x20 || c == 0x7f) {
      shown[i] = '?';
    }
    const bool continues_utf8 = (c & 0xc0U) == 0x80U;
    if (from + i < offset && !continues_utf8) caret += ' ';
  }
  caret += '^';
  return name + ":" + std::to_string(line) + ":" + std::to_string(offset - begin + 1) +
         ": error: " + std::string(message) + "\n  " + shown + "\n  " + caret;
}

}  // namespace kaboum::plan
