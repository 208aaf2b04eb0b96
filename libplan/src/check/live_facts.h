#pragma once

#include <kaboum/plan/plan.h>

#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "check/query_evaluator.h"
#include "check/runtime_knowledge.h"

namespace kaboum::plan {

Fact branch_fact(const Plan::Branch& b);

/// Slots of an action with its arguments in place.
std::vector<Index> bind(const Action& a, const PlanAction& action);

/// What each node of a plan, and all that may follow it, reads, but for what external functions ask
/// of the state; knowledge of anything else can be dropped there.
///
/// Of conditions that are no literals, and whose facts no node from there on can change, it is
/// enough to know that they hold (docs/planning/plans.md, "Checking").
class LiveFacts {
 public:
  /// Whether to sense is to read: it is where sets of worlds are kept, in which what is sensed may
  /// tell of anything else.
  enum class Sensing : std::uint8_t { DoesNotRead, Reads };

  /// @pre the plan has no cycles; all arguments outlive it.
  LiveFacts(const Model& model, const Plan& plan, const QueryEvaluator& evaluator,
            Sensing sensing = Sensing::DoesNotRead);

  struct Reads {
    std::set<Fact> facts;
    bool all = false;  ///< rules may read anything
  };
  /// kNone: the end, where the goal is read.
  [[nodiscard]] const Reads& at(Index node) const { return node == kNone ? goal_ : by_node_[node]; }

  /// All of a state that a node, and what follows it, can tell: of states with equal residues at a
  /// node either all are replayed without a violation or none is.
  struct Residue {
    RuntimeKnowledge state;
    std::vector<Index> settled;  ///< conditions that hold whatever comes
    [[nodiscard]] bool operator<(const Residue& other) const {
      return settled != other.settled ? settled < other.settled : state < other.state;
    }
  };
  /// @param asked  facts that external functions ask of the state from there on.
  [[nodiscard]] Residue residue(Index node, RuntimeKnowledge state,
                                const std::set<Fact>& asked) const;

 private:
  /// A part of a precondition or of the goal that is no literal, with its objects in place.
  struct Condition {
    const Query* query;
    std::vector<Index> slots;
    std::set<Fact> facts;  ///< that it reads
  };
  /// What one node, or the goal, reads and changes by itself.
  struct Part {
    std::set<Fact> always;  ///< read by anything but conditions
    std::set<Index> conditions;
    std::set<Fact> changed;
    bool all = false;
  };
  /// Of a node with all that may follow it.
  struct Future {
    std::set<Fact> always;
    std::vector<Index> open;  ///< conditions that may be settled: nothing changes their facts
  };

  [[nodiscard]] std::vector<Index> order(const Plan& plan) const;
  void read_action(const PlanAction& action, Part& part);
  void read_query(const Query& q, std::vector<Index>& slots, const std::set<Index>& bound,
                  Part& part);
  void read_effect(const Effect& e, std::vector<Index>& slots, Part& part) const;
  [[nodiscard]] std::set<Fact> unsure_at_start() const;
  [[nodiscard]] bool is_settled(const Condition& c, const RuntimeKnowledge& k,
                                const std::set<Fact>& tied) const;

  const Model& model_;
  const QueryEvaluator& evaluator_;
  Sensing sensing_;
  Reads goal_;
  std::vector<Reads> by_node_;
  std::vector<Condition> conditions_;
  std::map<std::pair<const Query*, std::vector<Index>>, Index> numbers_;  ///< of conditions
  Future end_;
  std::vector<Future> futures_;
};

}  // namespace kaboum::plan
