#pragma once

#include <kaboum/plan/model.h>

#include <vector>

#include "language/scope.h"
#include "language/symbol_table.h"
#include "language/syntax.h"
#include "language/unfolding.h"

namespace kaboum::plan {

/// Looks up the terms of queries and effects.
/// All functions throw Error{InvalidInput} at an unknown name, a wrong arity or a wrong type.
class TermResolver {
 public:
  explicit TermResolver(const SymbolTable& symbols) : symbols_(symbols) {}

  /// How the type of a variable must fit the wanted one. Related: either may be the other's
  /// subtype, as in a comparison.
  enum class Typing { Subtype, Related };

  /// A variable, a constant, or (unfolded) a function term in the place of an argument.
  Argument argument(const syntax::Term& t, Index wanted, Scope& scope,
                    std::vector<Unfolded>& unfolded, Typing typing = Typing::Subtype) const;
  std::vector<Argument> arguments(const syntax::Term& t, const Symbol& s, Scope& scope,
                                  std::vector<Unfolded>& unfolded) const;

  /// A variable or a constant: nothing to unfold.
  [[nodiscard]] bool is_plain(const syntax::Term& t) const;

  [[nodiscard]] const SymbolTable& symbols() const { return symbols_; }

 private:
  Argument handle_term(const syntax::Term& t, Index wanted, Scope& scope) const;
  Argument unfold(const syntax::Term& t, Index wanted, Scope& scope,
                  std::vector<Unfolded>& unfolded) const;
  [[nodiscard]] const Model& model() const { return symbols_.model(); }

  const SymbolTable& symbols_;
};

}  // namespace kaboum::plan
