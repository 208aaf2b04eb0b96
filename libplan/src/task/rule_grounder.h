#pragma once

#include <kaboum/plan/model.h>

#include <map>
#include <vector>

#include "task/derived_atoms.h"
#include "task/formula.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

class QueryGrounder;

/// Makes formulas of derived atoms: their rules where these are small and not recursive, else an
/// atom of DerivedAtoms.
class RuleGrounder {
 public:
  /// @pre all arguments outlive it.
  RuleGrounder(const Model& model, Limits& limits, FormulaPool& pool, DerivedAtoms& atoms);

  /// When the atom holds. The outermost call defines all atoms that it comes upon.
  Formula atom(Index predicate, const std::vector<Index>& objects, QueryGrounder& queries);

 private:
  struct Pending {
    Index atom;
    Index predicate;
    std::vector<Index> objects;
  };

  Formula body(Index predicate, const std::vector<Index>& objects, QueryGrounder& queries);
  [[nodiscard]] bool is_large(Formula f) const;
  void define_pending(QueryGrounder& queries);

  const Model& model_;
  Limits& limits_;
  FormulaPool& pool_;
  DerivedAtoms& atoms_;
  std::vector<std::vector<Rule>> rules_;  ///< by predicate
  std::vector<char> named_;  ///< by predicate: its atoms are named, whatever their size
  std::vector<std::map<std::vector<Index>, Formula>> formulas_;  ///< by predicate
  std::vector<Pending> pending_;
  bool defining_ = false;
};

}  // namespace kaboum::plan
