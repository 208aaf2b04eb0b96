#pragma once

#include <kaboum/plan/model.h>

#include <utility>
#include <vector>

#include "language/term_resolver.h"

namespace kaboum::plan {

/// Slot and type of variables that something quantifies.
using BoundSlots = std::vector<std::pair<Index, Index>>;

/// Turns formulas of the syntax into queries of the model.
/// All functions throw Error{InvalidInput} at what is unknown or has no meaning.
class QueryResolver {
 public:
  explicit QueryResolver(const TermResolver& terms) : terms_(terms) {}

  Query query(const syntax::Formula& f, Scope& scope) const;
  /// The same, and `let` among the conjuncts.
  Query precondition(const syntax::Formula& f, Scope& scope) const;

  /// K(p(arguments)), or of a derived predicate that it holds.
  Query atom(const syntax::Term& t, Scope& scope, std::vector<Unfolded>& unfolded) const;

  /// New variables in scope, for the caller to take out again.
  BoundSlots bind(const std::vector<syntax::TypedVariable>& variables, Scope& scope) const;
  /// Variables of an LCW pattern that nothing binds stand for every object: they are bound here.
  BoundSlots bind_wildcards(const syntax::Term& t, Scope& scope) const;

  [[nodiscard]] const SymbolTable& symbols() const { return terms_.symbols(); }

 private:
  Query let(const syntax::Formula& f, Scope& scope) const;
  void require_plain(const syntax::Term& t, const Argument& a, Index type) const;
  Query quantified(const syntax::Formula& f, Query::Kind kind, Scope& scope) const;
  Query known(const syntax::Formula& f, bool negated, Scope& scope) const;
  Query external_condition(const syntax::Term& t, Scope& scope) const;
  Query equality(const syntax::Formula& f, bool negated, Scope& scope) const;
  Query predicate_equality(const syntax::Term& predicate, const syntax::Term& external,
                           bool negated, Scope& scope) const;
  Query external_equality(const syntax::Term& call, const syntax::Term& other, bool negated,
                          Scope& scope) const;
  Query function_equality(const syntax::Term& left, const syntax::Term& right, bool negated,
                          Scope& scope) const;
  Query know_whether(const syntax::Formula& f, Scope& scope) const;
  Query know_value(const syntax::Formula& f, Scope& scope) const;
  Query closed_world(const syntax::Formula& f, Scope& scope) const;
  [[nodiscard]] const Model& model() const { return symbols().model(); }

  const TermResolver& terms_;
};

}  // namespace kaboum::plan
