// Places in a file, and quotations from it, for messages.
#include "source.h"

#include <kaboum/base/error.h>

namespace kaboum::io {

std::string place(const Source& source, const char* where) {
  const auto offset = static_cast<std::size_t>(where - source.begin());
  if (!source.text) return "byte " + std::to_string(offset);
  std::size_t line = 1;
  for (std::size_t i = 0; i < offset; ++i) {
    const char c = source.bytes[i];
    const bool lone_return =
        c == '\r' && (i + 1 == source.bytes.size() || source.bytes[i + 1] != '\n');
    if (c == '\n' || lone_return) ++line;
  }
  return "line " + std::to_string(line);
}

std::string in_quotes(std::string_view text, std::size_t longest) {
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += c < ' ' || c > '~' ? '?' : c;
  if (text.size() > longest) result += "...";
  return result + "'";
}

std::string counted(std::size_t count, std::string_view singular, std::string_view plural) {
  return std::to_string(count).append(" ").append(count == 1 ? singular : plural);
}

void fail(const Source& source, const char* where, const std::string& what) {
  fail(source, place(source, where) + ": " + what);
}

void fail(const Source& source, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, std::string(source.name) + ": " + what);
}

}  // namespace kaboum::io
