#pragma once

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "search/fact_table.h"
#include "search/relation.h"
#include "task/task.h"

namespace kaboum::plan {

/// A step of a join: an atom of the precondition, or a parameter that no atom has.
struct Join {
  const Query* atom = nullptr;  ///< nullptr: all candidates for a parameter
  Index parameter = 0;
  Index lookup = kNone;                      ///< kNone: all is bound, so it is only tested
  std::vector<ActionSchema::Check*> checks;  ///< bound after it
};
/// How the instances of an action are found that a fact completes.
struct JoinRule {
  Index schema = 0;
  const Query* trigger = nullptr;  ///< nullptr: applied once
  std::vector<ActionSchema::Check*> checks;
  std::vector<Join> joins;
};
/// What of an action is joined, and what is tested.
struct JoinedAction {
  std::vector<const Query*> atoms;
  std::vector<std::vector<Index>> candidate_of;     ///< by parameter and object; kNone: is none
  std::vector<ActionSchema::Check*> ordered, rest;  ///< checks that are no atoms; of them, tested
                                                    ///< as soon as their parameters are bound
};

/// What the delete relaxation of a task reaches, where contents that a fluent has had stay
/// available: facts, and actions.
///
/// Positive atoms of a precondition are joined: each fact that is reached is matched with the atoms
/// that it can stand for, and the rest of the precondition looked up from there, so an instance is
/// found when its last atom is reached. What else an instance needs is tested then, and again
/// while new facts are reached.
class Reachability {
 public:
  /// Calls of external functions may have any value; none where these say that it is impossible; or
  /// where they found nothing either, as often as they were to look.
  enum class Answers : std::uint8_t { Any, AsGiven, AsFound };

  /// But for Any, functions that refuse early are asked of the initial state.
  /// @param without  a call that has no value.
  /// @pre the arguments outlive it. @throws LimitExceeded
  Reachability(Task& task, Limits& limits, const FactTable& facts, Answers answers = Answers::Any,
               Index without = kNone);

  [[nodiscard]] bool reached(FactId f) const { return reached_[f] != 0; }
  /// Whether the formula, or its negation, may hold.
  [[nodiscard]] bool possible(Formula f, bool positive) const;
  /// Those whose preconditions may hold, by how many
  /// actions come before it at least, schema and arguments.
  [[nodiscard]] const std::vector<OperatorId>& actions() const { return actions_; }

 private:
  struct Pending {
    Index schema;
    std::vector<Index> arguments;
  };
  enum class Verdict { Reached, NotYet, Never };

  void start();
  void make_relations();
  void make_schema(Index schema);
  void make_rule(Index schema, const Query* trigger);
  [[nodiscard]] double matches(const Query& atom, const std::vector<char>& bound) const;
  void run();
  void take(FactId f);
  void apply(const JoinRule& rule, const std::vector<Index>& arguments);
  void join(const JoinRule& rule, std::size_t depth);
  bool match(const JoinedAction& schema, const Query& atom, const Index* arguments);
  bool bind(const JoinedAction& schema, Index parameter, Index object);
  void unbind(std::size_t mark);
  bool consistent(Index schema, const std::vector<ActionSchema::Check*>& checks);
  [[nodiscard]] bool holds(const Query& atom) const;
  Verdict test(Index schema);
  void instance(Index schema);
  void act(OperatorId step);
  bool act(OperatorId step, Index effect);
  bool again();
  void mark(FactId f);
  [[nodiscard]] bool may_answer(Index node) const;
  [[nodiscard]] bool may_have_value(Index call) const;

  Task& task_;
  Limits& limits_;
  const FactTable& facts_;
  Answers answers_;
  Index without_;
  mutable std::set<Index> asked_;  ///< calls, of the initial state
  std::vector<char> reached_;
  std::vector<char> taken_;      ///< by fluent of an atom: that it is true is joined
  std::vector<char> acted_;      ///< by step
  std::vector<Index> layer_of_;  ///< by step
  Index layer_ = 0;              ///< of the fact at hand
  std::vector<FactId> queue_;    ///< facts that were reached
  std::vector<OperatorId> actions_;
  std::vector<Relation> relations_;         ///< by predicate: atoms that may be true
  std::vector<std::size_t> sizes_at_most_;  ///< of them, in the end
  std::vector<JoinedAction> schemas_;
  std::vector<JoinRule> rules_;
  std::vector<std::vector<Index>> triggered_;  ///< by predicate: rules
  std::vector<Pending> pending_;
  std::vector<std::pair<OperatorId, Index>> pending_effects_;

  // Of the instance at hand.
  std::vector<Index> slots_;
  std::vector<char> bound_;
  std::vector<Index> trail_;  ///< parameters in the order in which they were bound
};

}  // namespace kaboum::plan
