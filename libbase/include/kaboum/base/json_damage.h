#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>

namespace kaboum {

/// Of a byte of a text: "line 3, column 7".
inline std::string place_in_text(std::string_view text, std::size_t at) {
  const std::string_view before = text.substr(0, at);
  const auto lines = std::count(before.begin(), before.end(), '\n');
  const std::size_t start = before.rfind('\n');
  const std::size_t column = at - (start == std::string_view::npos ? 0 : start + 1) + 1;
  return "line " + std::to_string(lines + 1) + ", column " + std::to_string(column);
}

/// Description of the place where a text stops being JSON: "the JSON is cut short: it ends at line
/// 3, column 7", or "not JSON at line 3, column 7, near '...'".
/// @param byte  how many bytes a parser had read when it gave up.
inline std::string describe_json_damage(std::string_view text, std::size_t byte) {
  const std::string_view read = text.substr(0, byte);
  const auto lines = std::count(read.begin(), read.end(), '\n');
  const std::size_t start = read.rfind('\n');
  const std::size_t column = read.size() - (start == std::string_view::npos ? 0 : start + 1);
  const std::string place = "line " + std::to_string(lines + 1) + ", column " +
                            std::to_string(std::max<std::size_t>(column, 1));
  if (byte > text.size()) return "the JSON is cut short: it ends at " + place;
  constexpr std::size_t kBefore = 10, kMost = 20;
  std::string near;
  const std::string_view line = text.substr(start == std::string_view::npos ? 0 : start + 1);
  for (const char c : line.substr(column - std::min(column, kBefore), kMost)) {
    if (c == '\n' || c == '\r') break;
    near += c < ' ' || c > '~' ? '?' : c;  // of UTF-8, characters may be cut
  }
  return "not JSON at " + place + (near.empty() ? "" : ", near '" + near + "'");
}

/// Largest depth that the lists and objects of JSON from elsewhere may be in each other: values are
/// copied, compared and written by recursion.
constexpr std::size_t kDeepestJson = 64;

/// True if they are deeper, as far as the text is JSON.
inline bool is_nested_too_deep(std::string_view text) {
  std::size_t depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '"')
      quoted = !quoted;
    else if (quoted)
      i += c == '\\' ? 1 : 0;
    else if (c == '[' || c == '{')
      ++depth;
    else if ((c == ']' || c == '}') && depth > 0)
      --depth;
    if (depth > kDeepestJson) return true;
  }
  return false;
}

/// "more than 64 lists and objects in each other".
inline std::string describe_json_depth() {
  return "more than " + std::to_string(kDeepestJson) + " lists and objects in each other";
}

}  // namespace kaboum
