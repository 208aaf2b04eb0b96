#pragma once

#include <kaboum/plan/model.h>

#include <utility>
#include <vector>

#include "task/atom_knowledge.h"
#include "task/numbering.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// What can change: atoms and terms that some effect of an instance of an action names, if the
/// constant knowledge does not refute its precondition; and what initial entries leave open. All
/// else keeps its initial knowledge in every state.
class ChangeAnalysis {
 public:
  /// @throws Error{LimitReached} if there is too much to look at; LimitExceeded.
  ChangeAnalysis(const Model& model, const Numbering& numbering, Limits& limits);

  using Atom = std::pair<Index, std::vector<Index>>;  ///< predicate, arguments

  std::vector<char> atom_changes, term_changes;  ///< by number
  std::vector<AtomKnowledge> atom_constants;     ///< by number: initial knowledge
  std::vector<Index> term_constants;             ///< by number: initial value; kNone: unknown
  std::vector<char> function_exclusions;         ///< by function: values may be ruled out
  std::vector<std::vector<Atom>> group_atoms;    ///< atoms of each entry of Kx
  bool sensing = false;                          ///< whether anything is sensed

 private:
  void scan(const Update& u, bool initial);
  void initial_constants();
  void close_constants();
  void mark(const Update::Literal& l, const Index* slots);
  void mark_update(const Update& u, const Index* slots);
  void mark_effects(const std::vector<Effect>& effects, std::vector<Index>& slots);
  void mark_action(const Action& a);
  void mark_all();
  [[nodiscard]] bool is_constant(const Query& q) const;
  [[nodiscard]] bool refuted(const Query& q, const Index* slots) const;
  [[nodiscard]] bool holds(const Query& q, const Index* slots) const;
  [[nodiscard]] std::size_t number(const Update::Literal& l, const Index* arguments) const {
    return l.function ? numbering_.term(l.symbol, arguments) : numbering_.atom(l.symbol, arguments);
  }

  const Model& model_;
  const Numbering& numbering_;
  Limits& limits_;
  std::vector<char> predicate_changes_, function_changes_;  ///< some effect names the symbol
  std::vector<char> open_symbols_;  ///< predicates with initial entries of Kw or Kx
  std::size_t visits_ = 0;          ///< bindings looked at
};

}  // namespace kaboum::plan
