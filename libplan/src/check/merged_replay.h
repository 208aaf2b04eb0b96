#pragma once

#include <kaboum/plan/plan.h>

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "check/live_facts.h"
#include "check/query_evaluator.h"
#include "check/runtime_knowledge.h"
#include "check/transitions.h"

namespace kaboum::plan {

/// Replays a plan once for each of its nodes, from what is known in all runs that come there: where
/// more knowledge never harms, what works from that works in each of them.
class MergedReplay {
 public:
  MergedReplay(const Model& model, const Plan& plan, const QueryEvaluator& evaluator,
               const LiveFacts& live, const Transitions& transitions)
      : model_(model), plan_(plan), evaluator_(evaluator), live_(live), transitions_(transitions) {}

  /// Whether queries that hold go on to hold when more is known, and no action does more or less
  /// for it: no negations of what is known, external functions, observations, or conditions of
  /// effects but those of the world.
  static bool takes(const Model& model);

  /// False says nothing: what runs have in common may not be enough.
  bool confirms();

 private:
  void arrive(Index node, RuntimeKnowledge k);
  bool carry_out(Index node, const RuntimeKnowledge& k);
  bool follow(const Plan::Branch& branch, RuntimeKnowledge k);
  [[nodiscard]] std::vector<Index> order() const;

  const Model& model_;
  const Plan& plan_;
  const QueryEvaluator& evaluator_;
  const LiveFacts& live_;
  const Transitions& transitions_;
  std::set<std::set<Fact>> entries_;  ///< of Kx, at the start
  std::map<Index, RuntimeKnowledge> arrived_;
};

}  // namespace kaboum::plan
