#pragma once

#include <kaboum/plan/model.h>

#include <set>
#include <vector>

#include "language/effect_resolver.h"

namespace kaboum::plan {

/// Makes the initial knowledge of a model, and the initial values of numeric functions.
class InitialState {
 public:
  InitialState(const TermResolver& terms, const EffectResolver& effects, Model& model)
      : terms_(terms), effects_(effects), model_(model) {}

  /// @throws Error{InvalidInput} at an entry that is not about constants;
  ///         Error{LimitReached} if closed predicates have too many atoms.
  void declare(const syntax::Document& document);

 private:
  void declare_unknown(const syntax::Document& document);
  /// Makes a predicate's atoms false that are not stated, unless nothing can tell.
  void close(Index predicate, std::vector<Update>& out);
  void close_predicate(Index predicate, std::vector<Argument> prefix, std::vector<Update>& out);
  void expand(const Effect& e, std::vector<Index>& values, const SourceLocation& location,
              std::vector<Update>& out) const;

  const TermResolver& terms_;
  const EffectResolver& effects_;
  Model& model_;
  std::set<std::vector<Index>> unknown_;  ///< predicate and arguments that closing leaves open
};

}  // namespace kaboum::plan
