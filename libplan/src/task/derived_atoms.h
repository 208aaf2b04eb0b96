#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "task/formula.h"

namespace kaboum::plan {

class FormulaEvaluator;

/// Derived atoms that formulas name: those of recursive rules, and those whose rules would make
/// formulas large. Where they hold in a state is worked out level by level when it is asked, and
/// kept until another state is asked about.
class DerivedAtoms {
 public:
  /// @pre both arguments outlive it.
  DerivedAtoms(const FormulaPool& pool, const Layout& layout) : pool_(pool), layout_(layout) {}

  /// A further atom, of a predicate of this level.
  Index add(Index level, bool recursive);
  /// Its rules, over atoms that are added by then. @pre it is defined once.
  void define(Index atom, Formula body);

  [[nodiscard]] Formula body(Index atom) const { return atoms_[atom].body; }
  [[nodiscard]] bool recursive(Index atom) const { return atoms_[atom].recursive; }
  [[nodiscard]] std::size_t size() const { return atoms_.size(); }

  /// Whether the atom is in the least fixed point of the rules.
  bool holds(Index atom, const Word* state, const FormulaEvaluator& evaluator);

  /// Fluents that the atoms of this atom's level, and of those below that it rests on, read.
  [[nodiscard]] std::vector<Index> fluents(Index atom) const;

 private:
  struct Atom {
    Index level = 0;
    bool recursive = false;
    Formula body = kFalse;
    std::vector<Index> users;  ///< atoms of its level whose body reads it
  };
  struct Level {
    std::vector<Index> atoms;
    std::vector<Index> below;  ///< levels that bodies read, ascending
    bool known = false;        ///< in the state at hand
  };

  [[nodiscard]] std::vector<Index> needed(Index level, bool all) const;
  void work_out(Level& level, const Word* state, const FormulaEvaluator& evaluator);

  const FormulaPool& pool_;
  const Layout& layout_;
  std::vector<Atom> atoms_;
  std::vector<Level> levels_;
  std::vector<Word> state_;  ///< the state at hand
  std::vector<char> truth_, waiting_;
  bool working_ = false;
};

}  // namespace kaboum::plan
