// What of a goal no plan brings about: facts out of reach, facts that exclude each other, and calls
// without whose value there is no plan.
#include <kaboum/plan/goal_explanation.h>

#include <algorithm>
#include <optional>

#include "search/invariants.h"
#include "search/reachability.h"
#include "search/relaxation.h"
#include "task/exactness.h"
#include "task/ground_text.h"
#include "task/knowledge_view.h"
#include "task/task.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMostFacts = 200;  // that are compared with each other
constexpr std::size_t kMostCalls = 64;

/// "K(f(a) = b)"; nullopt: of what is not known, or of a handle that comes into being.
std::optional<std::string> text_of(const Task& task, const FactTable& facts, FactId fact) {
  const Model& model = task.model();
  const Fluent& f = task.layout().fluents()[facts.fluent_of(fact)];
  const Word content = facts.content_of(fact);
  const std::string name = ground_text(
      model, (f.function ? model.functions : model.predicates)[f.symbol].name, f.arguments);
  if (f.function) {
    const std::vector<Index>& range = model.types[f.range].objects;
    if (content < kFirstValue || content - kFirstValue >= range.size()) return std::nullopt;
    return "K(" + name + " = " + model.objects[range[content - kFirstValue]].name + ")";
  }
  if (content == static_cast<Word>(AtomKnowledge::True)) return "K(" + name + ")";
  if (content == static_cast<Word>(AtomKnowledge::False)) return "K(!" + name + ")";
  return std::nullopt;
}

void explain_facts(Task& task, Limits& limits, GoalExplanation& out) {
  const Relaxation relaxation(task, limits);
  const FactTable& facts = relaxation.facts();
  const Reachability reachability(task, limits, facts);
  std::vector<std::pair<FactId, std::string>> needed;
  for (const FactId f : relaxation.necessary_facts(task.goal())) {
    const auto text = text_of(task, facts, f);
    if (!text) continue;
    if (!reachability.reached(f))
      out.unreachable.push_back(*text);
    else if (needed.size() < kMostFacts)
      needed.emplace_back(f, *text);
  }
  const Invariants invariants(task, relaxation, limits);
  for (std::size_t i = 0; i < needed.size(); ++i)
    for (std::size_t j = i + 1; j < needed.size(); ++j)
      if (invariants.exclusive(needed[i].first, needed[j].first))
        out.exclusive.emplace_back(needed[i].second, needed[j].second);
}

void explain_calls(Task& task, Limits& limits, const std::set<std::string>& calls,
                   GoalExplanation& out) {
  const FactTable facts(task.model(), task.layout());
  const auto leads_there = [&](Index without) {
    return Reachability(task, limits, facts, Reachability::Answers::Any, without)
        .possible(task.goal(), true);
  };
  if (!leads_there(kNone)) return;  // with all of them there is no plan
  std::size_t looked_at = 0;
  for (Index call = 0; call < task.calls().size() && looked_at < kMostCalls; ++call) {
    const std::string text = task.calls().constant_text(call);
    if (!calls.contains(text)) continue;
    ++looked_at;
    const Limits::Scope scope(limits);
    if (!leads_there(call)) out.needed.insert(text);
  }
}

}  // namespace

GoalExplanation explain_goal(const Model& model, const std::set<std::string>& calls,
                             const SolveOptions& options) {
  GoalExplanation out;
  Statistics statistics;
  Limits limits(options, statistics);
  try {
    // What knowledge states lose may be what leads to the goal.
    if (knowledge_view(model) || !lost_knowledge(model).empty()) return out;
    Task task(model, limits);
    out.never = task.goal() == kFalse;
    if (out.never) return out;
    explain_facts(task, limits, out);
    explain_calls(task, limits, calls, out);
  } catch (const LimitExceeded&) {
    // What was found by then is so.
  }
  return out;
}

}  // namespace kaboum::plan
