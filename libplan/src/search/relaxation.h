#pragma once

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "task/task.h"

namespace kaboum::plan {

/// A fluent with one of its contents: "p is known to be true", "f is known to be c", "p is
/// unknown".
using FactId = std::uint32_t;

/// The delete relaxation of a task: contents that a fluent has had stay available. Its reachable
/// actions, and the and-or graph of facts, formulas and actions that heuristics walk.
class Relaxation {
 public:
  Relaxation(Task& task, Limits& limits);

  /// One effect of one action, or of an outcome of sensing.
  struct Operator {
    OperatorId step = 0;
    std::int64_t cost = 0;
    std::vector<FactId> preconditions;  ///< facts that must hold (those that can be told as facts)
    std::vector<FactId> adds;
    Index node = 0;         ///< in the and-or graph
    Index conditional = 0;  ///< index into the action's effects
  };

  /// Whether the operator, where it happens, leaves the fluent with another content than `f` for
  /// certain, if nothing else that the action does gives it back.
  [[nodiscard]] bool ends(const Operator& op, FactId f) const;

  [[nodiscard]] FactId fact(Index fluent, Word content) const {
    return first_fact_[fluent] + static_cast<FactId>(std::min(content, contents_[fluent] - 1));
  }
  /// Number of contents told apart; of a handle, the last stands for all that come into being.
  [[nodiscard]] Word contents(Index fluent) const { return contents_[fluent]; }
  [[nodiscard]] std::size_t facts() const { return facts_; }
  [[nodiscard]] Index fluent_of(FactId f) const { return fluent_of_[f]; }
  [[nodiscard]] Word content_of(FactId f) const { return f - first_fact_[fluent_of_[f]]; }
  [[nodiscard]] bool holds(FactId f, const Word* state) const {
    return fact(fluent_of_[f], task_.layout().fluents()[fluent_of_[f]].get(state)) == f;
  }
  [[nodiscard]] const std::vector<Operator>& operators() const { return operators_; }
  [[nodiscard]] const std::vector<OperatorId>& actions() const { return actions_; }

  /// Facts that a formula cannot hold without.
  [[nodiscard]] std::vector<FactId> necessary_facts(Formula f) const;

  /// The and-or graph: nodes 0 ... facts()-1 are facts.
  struct Node {
    enum class Kind : std::uint8_t { Fact, All, Any } kind = Kind::Fact;
    std::vector<Index> children;
  };
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Node of a formula known when the relaxation was made (preconditions, conditions, the goal).
  Index node(Formula f, bool positive = true);

 private:
  void reach();
  void add_action(OperatorId step);
  void add_operator(Operator o, std::vector<Index> conditions);
  [[nodiscard]] bool possible(Formula f, bool positive) const;
  [[nodiscard]] std::vector<FactId> contents(const FormulaPool::Node& leaf, bool positive,
                                             bool& always) const;
  std::vector<FactId> added(const Change& change) const;
  std::vector<FactId> added(const ConditionalEffect& effect) const;
  bool mark(FactId f);

  Task& task_;
  Limits& limits_;
  std::size_t facts_ = 0;
  std::vector<FactId> first_fact_;
  std::vector<Word> contents_;
  std::vector<Index> fluent_of_;
  std::vector<char> reached_;
  std::vector<char> reached_action_;
  std::vector<OperatorId> actions_;
  std::vector<Operator> operators_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, Index> node_index_;
};

}  // namespace kaboum::plan
