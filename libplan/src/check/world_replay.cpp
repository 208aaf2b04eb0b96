// Replay of a plan over pairs of a node and a set of possible worlds, breadth first.
#include "check/world_replay.h"

#include <kaboum/base/error.h>

#include <algorithm>

namespace kaboum::plan {

WorldReplay::WorldReplay(const Model& model, const Plan& plan, std::uint64_t limit,
                         const CheckProgress& progress)
    : model_(model),
      plan_(plan),
      limit_(limit),
      progress_(progress),
      evaluator_(model, plan),
      live_(model, plan, evaluator_, LiveFacts::Sensing::Reads),
      rules_(model) {}

std::string WorldReplay::path(std::size_t v) const {
  std::vector<std::string> labels;
  for (; v != kNoParent; v = visits_[v].parent)
    if (!visits_[v].label.empty()) labels.push_back(visits_[v].label);
  std::string text;
  for (auto l = labels.rbegin(); l != labels.rend(); ++l) text += (text.empty() ? "" : "; ") + *l;
  return text.empty() ? "at the start" : "after " + text;
}

void WorldReplay::violate(std::size_t v, const std::string& what) {
  if (result_.violation.empty()) result_.violation = what + ", " + path(v);
}

void WorldReplay::visit(Index node, const WorldRules::Belief& b, std::size_t parent,
                        std::string label) {
  const auto [it, fresh] = seen_.emplace(node, rules_.restricted(b, live_.at(node).facts));
  if (!fresh) return;
  if (++result_.states > limit_)
    throw Error(ErrorCode::LimitReached,
                "more than " + std::to_string(limit_) + " states to replay");
  if (progress_) progress_(result_.states);
  visits_.push_back({node, &it->second, parent, std::move(label)});
}

std::optional<CheckResult> WorldReplay::run() {
  std::set<Fact> read = live_.at(plan_.root).facts;
  for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
    const auto& facts = live_.at(static_cast<Index>(n)).facts;
    read.insert(facts.begin(), facts.end());
  }
  const auto start = rules_.start(read);
  if (!start) return std::nullopt;
  for (const WorldRules::Belief& b : *start) visit(plan_.root, b, kNoParent, "");
  for (std::size_t v = 0; v < visits_.size() && result_.violation.empty(); ++v) replay(v);
  for (const auto& [node, v] : contradicted_)
    if (!passed_.contains(node))
      violate(v, "what " + action_text(model_, plan_.nodes[node].action) +
                     " observes contradicts what is known");
  result_.valid = result_.violation.empty();
  return result_;
}

void WorldReplay::replay(std::size_t v) {
  const Visit at = visits_[v];
  if (at.node == kNone) {
    ++result_.leaves;
    std::vector<Index> slots(std::max<Index>(model_.goal_slots, 1), 0);
    if (!rules_.holds(model_.goal, slots, *at.belief))
      violate(v, "the goal does not hold at an end of the plan");
    return;
  }
  const Plan::Node& node = plan_.nodes[at.node];
  std::vector<WorldRules::Belief> after = {*at.belief};
  std::string label;
  if (node.acts) {
    label = action_text(model_, node.action);
    const Action& a = model_.actions[node.action.schema];
    std::vector<Index> slots = bind(a, node.action);
    if (!rules_.holds(a.precondition, slots, *at.belief)) {
      violate(v, "the precondition of " + label + " does not hold");
      return;
    }
    after = rules_.after(a, slots, *at.belief);
    if (after.empty()) {
      contradicted_.try_emplace(at.node, v);
      return;
    }
    passed_.insert(at.node);
  }
  for (const WorldRules::Belief& b : after) {
    if (node.branches)
      follow(v, node.branch, b, label);
    else
      visit(node.next, b, v, label);
  }
}

void WorldReplay::follow(std::size_t v, const Plan::Branch& branch, const WorldRules::Belief& b,
                         const std::string& label) {
  const std::string prefix = label.empty() ? "" : label + "; ";
  const std::optional<Index> value = rules_.value(branch_fact(branch), b);
  if (!value) {
    violate(v, prefix + "the plan branches on " +
                   (branch.function ? "a value that" : case_text(model_, branch, 1) + ", which") +
                   " is not known");
    return;
  }
  for (const Plan::Branch::Case& c : branch.cases)
    if (c.value == *value) {
      visit(c.next, b, v, prefix + case_text(model_, branch, *value));
      return;
    }
  violate(v, prefix + "the plan has no case for " + case_text(model_, branch, *value));
}

}  // namespace kaboum::plan
