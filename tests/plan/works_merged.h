#pragma once

#include <optional>

#include "check/merged_replay.h"
#include "task/knowledge_view.h"

namespace kaboum::plan::test {

/// Whether the plan works from what runs that meet at a node have in common.
inline bool works_merged(const Model& m, const Plan& p) {
  if (!MergedReplay::takes(m)) return false;
  const std::optional<Model> view = knowledge_view(m);
  const Model& known = view ? *view : m;
  const QueryEvaluator evaluator(known, p);
  const LiveFacts live(known, p, evaluator);
  const Transitions transitions(known, evaluator);
  return MergedReplay(known, p, evaluator, live, transitions).confirms();
}

}  // namespace kaboum::plan::test
