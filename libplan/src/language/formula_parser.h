#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "language/syntax.h"
#include "language/token_stream.h"

namespace kaboum::plan {

/// Reads terms and formulas of .kpl. All functions throw Error{InvalidInput} at what is no such.
class FormulaParser {
 public:
  explicit FormulaParser(TokenStream& in) : in_(in) {}

  /// A query: operators by binding, the loosest first: | xor & !
  syntax::Formula formula();
  /// What stands inside K(...): an atom, an (in)equality, an extern, or its negation.
  syntax::Formula literal();
  syntax::Term term();
  /// The cost of an action: a number or a term.
  syntax::Term cost();
  /// ?x : type, ...
  std::vector<syntax::TypedVariable> parameters();

 private:
  [[nodiscard]] syntax::Formula make(syntax::Formula::Kind kind) const;
  syntax::Formula joined(syntax::Formula::Kind kind, std::string_view symbol,
                         syntax::Formula (FormulaParser::*operand)());
  syntax::Formula exclusive();
  syntax::Formula conjunction();
  syntax::Formula unary();
  std::optional<syntax::Formula> operator_with_parenthesis(syntax::Formula f);
  syntax::Formula let(syntax::Formula f);
  syntax::Formula modal(syntax::Formula f, syntax::Formula::Kind kind);
  syntax::Formula quantified(syntax::Formula f, syntax::Formula::Kind kind);
  syntax::Formula comparison(syntax::Formula f, syntax::Formula::Kind alone);
  syntax::Term number();
  [[noreturn]] void fail_query() const;

  TokenStream& in_;
};

}  // namespace kaboum::plan
