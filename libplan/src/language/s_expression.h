#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "language/source.h"

namespace kaboum::plan {

/// An s-expression: a word or a list. Words are lower case, as PDDL ignores case.
struct SExpression {
  bool list = false;
  std::string word;
  std::vector<SExpression> items;
  SourceLocation location;

  [[nodiscard]] bool is(std::string_view w) const { return !list && word == w; }
  [[nodiscard]] bool headed(std::string_view w) const {
    return list && !items.empty() && items[0].is(w);
  }
};

/// All expressions of a text. @throws Error{InvalidInput} at a parenthesis without its partner.
std::vector<SExpression> read_s_expressions(const Source& source);

}  // namespace kaboum::plan
