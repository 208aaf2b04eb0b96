#pragma once

#include <kaboum/plan/plan.h>

#include <cstdint>
#include <set>
#include <vector>

#include "check/query_evaluator.h"

namespace kaboum::plan {

Fact branch_fact(const Plan::Branch& b);

/// Slots of an action with its arguments in place.
std::vector<Index> bind(const Action& a, const PlanAction& action);

/// What each node of a plan, and all that may follow it, reads, but for what external functions ask
/// of the state; knowledge of anything else can be dropped there.
class LiveFacts {
 public:
  /// Whether to sense is to read: it is where sets of worlds are kept, in which what is sensed may
  /// tell of anything else.
  enum class Sensing : std::uint8_t { DoesNotRead, Reads };

  /// @pre the plan has no cycles.
  LiveFacts(const Model& model, const Plan& plan, const QueryEvaluator& evaluator,
            Sensing sensing = Sensing::DoesNotRead);

  struct Reads {
    std::set<Fact> facts;
    bool all = false;  ///< rules may read anything
  };
  /// kNone: the end, where the goal is read.
  [[nodiscard]] const Reads& at(Index node) const { return node == kNone ? goal_ : by_node_[node]; }

 private:
  void read_node(const Plan::Node& node, const std::vector<Index>& successors, Reads& live) const;
  void effect_reads(const Effect& e, std::vector<Index>& slots, Reads& out) const;

  const Model& model_;
  const QueryEvaluator& evaluator_;
  Sensing sensing_;
  Reads goal_;
  std::vector<Reads> by_node_;
};

}  // namespace kaboum::plan
