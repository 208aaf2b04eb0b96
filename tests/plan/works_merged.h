#pragma once

#include "check/merged_replay.h"

namespace kaboum::plan::test {

/// Whether the plan works from what runs that meet at a node have in common.
inline bool works_merged(const Model& m, const Plan& p) {
  if (!MergedReplay::takes(m)) return false;
  const QueryEvaluator evaluator(m, p);
  const LiveFacts live(m, p, evaluator);
  const Transitions transitions(m, evaluator, Transitions::Disjunctions::LeftOut);
  return MergedReplay(m, p, evaluator, live, transitions).confirms();
}

}  // namespace kaboum::plan::test
