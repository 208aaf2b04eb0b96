#pragma once

#include <kaboum/plan/model.h>

#include <vector>

#include "language/query_resolver.h"

namespace kaboum::plan {

/// Turns effects of the syntax, and entries of an initial state, into effects of the model.
/// All functions throw Error{InvalidInput} at what is unknown or a database cannot hold.
class EffectResolver {
 public:
  EffectResolver(const TermResolver& terms, const QueryResolver& queries)
      : terms_(terms), queries_(queries) {}

  Effect effect(const syntax::Effect& e, Scope& scope) const;

  /// An atom, an equality of a function, or a negation of one.
  Update::Literal literal(const syntax::Formula& f, bool negated, Scope& scope,
                          std::vector<Unfolded>& unfolded) const;

 private:
  Effect update_effect(const syntax::Effect& e, Scope& scope) const;
  Update update(const syntax::Effect& e, Scope& scope, std::vector<Unfolded>& unfolded) const;
  void exclusive(const syntax::Effect& e, Update& u, Scope& scope,
                 std::vector<Unfolded>& unfolded) const;
  [[nodiscard]] const SymbolTable& symbols() const { return terms_.symbols(); }
  [[nodiscard]] const Model& model() const { return symbols().model(); }

  const TermResolver& terms_;
  const QueryResolver& queries_;
};

}  // namespace kaboum::plan
