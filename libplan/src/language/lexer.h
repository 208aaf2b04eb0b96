#pragma once

#include <memory>
#include <vector>

#include "language/source.h"

namespace kaboum::plan {

struct Token {
  enum class Kind { Name, Variable, Number, Symbol, End };
  Kind kind = Kind::End;
  std::string text;  ///< of a variable: without the '?'
  std::size_t offset = 0;

  [[nodiscard]] bool is(std::string_view symbol) const {
    return (kind == Kind::Symbol || kind == Kind::Name) && text == symbol;
  }
};

/// Tokens of a .kpl text, the last of kind End. Comments: "--", "//" and "#" to the end of the
/// line.
/// @throws Error{InvalidInput} on a character that begins nothing.
std::vector<Token> tokenize(const Source& source);

}  // namespace kaboum::plan
