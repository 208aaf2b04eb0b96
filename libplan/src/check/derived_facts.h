#pragma once

#include <kaboum/plan/model.h>

#include <map>
#include <set>
#include <vector>

#include "check/query_evaluator.h"
#include "check/runtime_knowledge.h"

namespace kaboum::plan {

/// Derived atoms of one state: rules are evaluated on the lifted model as they are asked for, and
/// again where they are recursive, until nothing more comes to hold.
class DerivedFacts {
 public:
  /// @pre all arguments outlive it.
  DerivedFacts(const Model& model, const QueryEvaluator& evaluator, const RuntimeKnowledge& k);

  /// @param atom  as `fact` makes it.
  /// @throws Error{LimitReached} where too many predicates rest on one another to be followed.
  bool holds(const Fact& atom);

 private:
  /// Of a level that is worked out.
  struct Round {
    std::vector<Fact> roots;      ///< what is asked for, and what lay too deep
    std::map<Fact, bool> looked;  ///< atoms that were looked at, and whether they hold so far
    bool more = false;            ///< one came to hold, or lay too deep
  };

  bool decide(const Fact& atom);
  bool look(const Fact& atom, Round& round);
  bool by_rules(const Fact& atom);

  const Model& model_;
  const QueryEvaluator& evaluator_;
  const RuntimeKnowledge& k_;
  std::map<Fact, bool> decided_;
  std::map<Index, Round> rounds_;  ///< by level
  std::set<Fact> found_;           ///< atoms that hold
  std::vector<int> body_depth_;    ///< of each rule
  int depth_ = 0;                  ///< of calls, roughly
};

}  // namespace kaboum::plan
