#pragma once

#include <kaboum/base/error.h>

#include <cstddef>
#include <string>
#include <string_view>

namespace kaboum::plan {

/// Nesting of parentheses that readers take: recursion stays far from the stack's end.
inline constexpr int kMaximumNesting = 200;

/// A text with a name, and how to complain about a location in it.
struct Source {
  std::string name;
  std::string text;

  /// "name:line:column: error: message", the line itself, and a caret under the column.
  [[nodiscard]] std::string diagnostic(std::size_t offset, std::string_view message) const;

  /// @throws Error{InvalidInput} with that text.
  [[noreturn]] void fail(std::size_t offset, std::string_view message) const {
    throw Error(ErrorCode::InvalidInput, diagnostic(offset, message));
  }
};

/// A location in a source: what every name and operator of the syntax tree carries.
struct SourceLocation {
  const Source* source = nullptr;
  std::size_t offset = 0;

  [[noreturn]] void fail(std::string_view message) const {
    if (source == nullptr) throw Error(ErrorCode::InvalidInput, std::string(message));
    source->fail(offset, message);
  }
};

}  // namespace kaboum::plan
