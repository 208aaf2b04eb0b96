// Ground steps by the facts that they need.
#include "search/applicable_steps.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace kaboum::plan {
namespace {

constexpr std::size_t kDeepest = 8;  // facts that a step is found by

}  // namespace

ApplicableSteps::ApplicableSteps(const Task& task, const Relaxation& relaxation)
    : task_(task), facts_(relaxation.facts()) {
  const FormulaPool& pool = task.pool();
  // The facts that each step needs, and how many steps need each.
  std::vector<std::vector<FactId>> needs;
  std::vector<Index> needed(facts_.size(), 0);
  std::vector<OperatorId> actions = relaxation.actions();
  std::sort(actions.begin(), actions.end(), [&](OperatorId a, OperatorId b) {
    const GroundAction& x = task.action(a);
    const GroundAction& y = task.action(b);
    return std::tie(x.schema, x.arguments) < std::tie(y.schema, y.arguments);
  });
  for (const OperatorId a : actions) {
    Step s;
    s.step = a;
    s.first_test = static_cast<Index>(tests_.size());
    s.first_rest = static_cast<Index>(rest_.size());
    const Formula f = task.action(a).precondition;
    const bool all = pool.node(f).kind == FormulaPool::Kind::And;
    const Formula* c = all ? pool.begin(f) : &f;
    const Formula* const end = all ? pool.end(f) : c + 1;
    for (; c != end; ++c) {
      if (const auto bits = pool.as_bits(*c)) {
        const auto same = std::find_if(
            tests_.begin() + s.first_test, tests_.end(),
            [&](const BitTest& t) { return t.word == bits->word && (t.mask & bits->mask) == 0; });
        if (same == tests_.end()) {
          tests_.push_back(*bits);
        } else {
          same->mask |= bits->mask;
          same->value |= bits->value;
        }
      } else if (*c != kTrue && !(pool.node(*c).calls && task.evaluator().depends_on_calls(*c))) {
        rest_.push_back(*c);
      }
    }
    s.last_test = static_cast<Index>(tests_.size());
    s.last_rest = static_cast<Index>(rest_.size());
    steps_.push_back(s);
    needs.push_back(relaxation.necessary_facts(f));
    for (const FactId x : needs.back()) ++needed[x];
  }
  // What each is found by: facts that many steps need come first, so that much is left out early.
  std::vector<std::vector<FactId>> paths(steps_.size());
  for (Index i = 0; i < steps_.size(); ++i) {
    std::vector<FactId>& path = paths[i];
    for (const FactId f : needs[i])
      if (distinguishes(f)) path.push_back(f);
    const auto comes_first = [&](FactId a, FactId b) {
      return std::pair(needed[b], a) < std::pair(needed[a], b);
    };
    std::sort(path.begin(), path.end(), comes_first);
    path.resize(std::min(path.size(), kDeepest));
  }
  order_.resize(steps_.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::stable_sort(order_.begin(), order_.end(),
                   [&](Index a, Index b) { return paths[a] < paths[b]; });
  grow(paths, 0, static_cast<Index>(order_.size()), 0, {});
}

/// What is false is so in most states; of handles not all have a fact of their own.
bool ApplicableSteps::distinguishes(FactId f) const {
  const Fluent& fluent = task_.layout().fluents()[facts_.fluent_of(f)];
  if (fluent.function) return !fluent.handle;
  return facts_.content_of(f) != static_cast<Word>(AtomKnowledge::False);
}

/// A node for the steps order_[begin ... end), whose paths are the same up to `depth`.
/// @param test  of the fact that leads there
void ApplicableSteps::grow(const std::vector<std::vector<FactId>>& paths, Index begin, Index end,
                           std::size_t depth, const BitTest& test) {
  const std::size_t node = nodes_.size();
  Index next = begin;
  while (next < end && paths[order_[next]].size() == depth) ++next;
  nodes_.push_back({test, begin, next, 0});
  while (next < end) {
    const FactId f = paths[order_[next]][depth];
    const Fluent& fluent = task_.layout().fluents()[facts_.fluent_of(f)];
    const Index first = next;
    while (next < end && paths[order_[next]][depth] == f) ++next;
    grow(paths, first, next, depth + 1,
         {fluent.word, fluent.mask, facts_.content_of(f) << fluent.shift});
  }
  nodes_[node].skip = static_cast<Index>(nodes_.size());
}

bool ApplicableSteps::applicable(const Step& s, const Word* state) const {
  for (Index i = s.first_test; i < s.last_test; ++i)
    if (!tests_[i].holds(state)) return false;
  for (Index i = s.first_rest; i < s.last_rest; ++i)
    if (!task_.evaluator().holds(rest_[i], state)) return false;
  return task_.settled(state, s.step);
}

void ApplicableSteps::find(const Word* state, std::vector<OperatorId>& steps) {
  steps.clear();
  found_.clear();
  for (Index n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    if (!node.test.holds(state)) {
      n = node.skip;
      continue;
    }
    for (Index i = node.first; i < node.last; ++i)
      if (applicable(steps_[order_[i]], state)) found_.push_back(order_[i]);
    ++n;
  }
  std::sort(found_.begin(), found_.end());
  for (const Index i : found_) steps.push_back(steps_[i].step);
}

}  // namespace kaboum::plan
