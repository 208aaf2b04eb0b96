#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "search/fact_table.h"
#include "search/reachability.h"
#include "task/task.h"

namespace kaboum::plan {

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

  /// Whether the operator, where it happens, ends the fact for certain, if nothing else that the
  /// action does gives it back.
  [[nodiscard]] bool ends(const Operator& op, FactId f) const {
    return !task_.is_outcome(op.step) &&  // learning changes nothing
           facts_.ends(task_.action(op.step).effects[op.conditional], f);
  }

  [[nodiscard]] const FactTable& facts() const { return facts_; }
  [[nodiscard]] const std::vector<Operator>& operators() const { return operators_; }
  [[nodiscard]] const std::vector<OperatorId>& actions() const { return reachability_.actions(); }

  /// Facts that a formula cannot hold without.
  [[nodiscard]] std::vector<FactId> necessary_facts(Formula f) const;

  /// The and-or graph: nodes 0 ... facts().size()-1 are facts.
  struct Node {
    enum class Kind : std::uint8_t { Fact, All, Any } kind = Kind::Fact;
    std::vector<Index> children;
  };
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Node of a formula known when the relaxation was made (preconditions, conditions, the goal).
  Index node(Formula f, bool positive = true);

 private:
  /// A derived atom whose rules are still to be made nodes of.
  struct Pending {
    Index node;
    Formula body;
    bool positive;
  };

  Index make_node(Formula f, bool positive);
  void add_action(OperatorId step);
  [[nodiscard]] bool senses_unknown(const GroundAction& action, const Change& change) const;
  void add_operator(Operator o, std::vector<Index> conditions);

  Task& task_;
  Limits& limits_;
  FactTable facts_;
  Reachability reachability_;
  std::vector<Operator> operators_;
  std::vector<Node> nodes_;
  std::unordered_map<std::uint64_t, Index> node_index_;
  std::vector<Pending> pending_;
};

}  // namespace kaboum::plan
