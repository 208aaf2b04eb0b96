// Ground steps by the facts that they need.
#include "search/applicable_steps.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace kaboum::plan {

ApplicableSteps::ApplicableSteps(const Task& task, const Relaxation& relaxation)
    : task_(task), facts_(relaxation.facts()) {
  const FormulaPool& pool = task.pool();
  watchers_.resize(facts_.size());
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
  std::vector<char> watched(task.layout().fluents().size(), 0);
  for (Index i = 0; i < steps_.size(); ++i) {
    if (needs[i].empty()) {
      always_.push_back(i);
      continue;
    }
    // What is false is so in most states.
    const auto rank = [&](FactId x) {
      const bool negative = !task.layout().fluents()[facts_.fluent_of(x)].function &&
                            facts_.content_of(x) == static_cast<Word>(AtomKnowledge::False);
      return std::pair(negative, needed[x]);
    };
    const FactId rarest = *std::min_element(needs[i].begin(), needs[i].end(),
                                            [&](FactId a, FactId b) { return rank(a) < rank(b); });
    watchers_[rarest].push_back(i);
    watched[facts_.fluent_of(rarest)] = 1;
  }
  for (Index i = 0; i < watched.size(); ++i)
    if (watched[i]) watched_fluents_.push_back(i);
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
  const auto look = [&](const std::vector<Index>& at) {
    for (const Index i : at)
      if (applicable(steps_[i], state)) found_.push_back(i);
  };
  look(always_);
  for (const Index i : watched_fluents_)
    look(watchers_[facts_.fact(i, task_.layout().fluents()[i].get(state))]);
  std::sort(found_.begin(), found_.end());
  for (const Index i : found_) steps.push_back(steps_[i].step);
}

}  // namespace kaboum::plan
