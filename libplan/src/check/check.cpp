// The validator: a plan is replayed over pairs of a node and a state of knowledge, each once:
// breadth first, where it is known beforehand what is read from a node on; else depth first, and a
// state is one that was replayed if it agrees with it on all that was read from there on. Where a
// condition further down is settled, that it holds is all that states need to agree on. It reads
// the lifted model, and includes nothing of the planner: scripts/include-graph sees to it.
#include <kaboum/base/error.h>
#include <kaboum/plan/check.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include "check/live_facts.h"
#include "check/merged_replay.h"
#include "check/query_evaluator.h"
#include "check/runtime_knowledge.h"
#include "check/transitions.h"
#include "check/world_replay.h"

namespace kaboum::plan {
namespace {

class Checker {
 public:
  Checker(const Model& model, const Plan& plan, std::uint64_t limit, const CheckProgress& progress,
          MissingCases missing)
      : model_(model),
        plan_(plan),
        limit_(limit),
        progress_(progress),
        missing_(missing),
        evaluator_(model, plan),
        live_(model, plan, evaluator_),
        transitions_(model, evaluator_, Transitions::Disjunctions::LeftOut,
                     Transitions::Outcomes::MayBeOpen),
        depth_first_(std::ranges::any_of(model.external_functions, &ExternalFunction::reads_state)),
        kept_less_(std::ranges::any_of(model.initial, is_disjunction)) {}

  CheckResult run() {
    std::vector<RuntimeKnowledge> initial = transitions_.initial_states();
    const bool begins = !initial.empty();
    for (RuntimeKnowledge& k : initial) visit(plan_.root, std::move(k), kNoParent, "");
    if (depth_first_) replay_depth_first();
    while (!queue_.empty() && result_.violation.empty()) {
      if (!tried_at_once_ && visits_.size() >= kManyVisits && confirmed_at_once()) return result_;
      const auto [v, state] = std::move(queue_.front());
      queue_.pop_front();
      visits_[v].state = &state;
      replay(v);
    }
    for (const auto& [node, v] : contradicted_)
      if (!passed_.contains(node))
        violate(v, "what " + action_text(model_, plan_.nodes[node].action) +
                       " observes contradicts what is known");
    if (const auto call = evaluator_.unused_choice(); call && begins && result_.violation.empty())
      result_.violation = "the plan states a choice of '" + *call + "', a call that it never makes";
    result_.valid = result_.violation.empty();
    ensure(!result_.valid || result_.leaves > 0 || !begins, "some run comes to an end of the plan");
    return result_;
  }

  /// Whether some state that was replayed kept less than follows: what is refuted there may be
  /// right all the same.
  [[nodiscard]] bool kept_less() const { return kept_less_; }

 private:
  /// Of several of them, states do not conclude all that follows.
  static bool is_disjunction(const Update& u) {
    return u.database == Update::Database::Or ||
           (u.database == Update::Database::Kx && !u.literals[0].function);
  }

  static constexpr std::size_t kNoParent = ~std::size_t{0};
  static constexpr std::size_t kManyVisits = 20'000;

  /// Is tried once.
  bool confirmed_at_once() {
    tried_at_once_ = true;
    if (!MergedReplay::takes(model_)) return false;
    try {
      const Transitions apart(model_, evaluator_, Transitions::Disjunctions::LeftOut);
      result_.valid = MergedReplay(model_, plan_, evaluator_, live_, apart).confirms();
    } catch (const Error& e) {
      // What runs have in common may leave more outcomes open than can be looked at.
      if (e.code() != ErrorCode::LimitReached) throw;
    }
    result_.leaves = std::max<decltype(result_.leaves)>(result_.leaves, result_.valid ? 1 : 0);
    return result_.valid;
  }

  struct Visit {
    Index node;
    const RuntimeKnowledge* state;  ///< while it is replayed
    std::size_t parent;
    std::string label;
  };

  std::string path(std::size_t v) const {
    std::vector<std::string> labels;
    for (; v != kNoParent; v = visits_[v].parent)
      if (!visits_[v].label.empty()) labels.push_back(visits_[v].label);
    std::string text;
    for (auto l = labels.rbegin(); l != labels.rend(); ++l) text += (text.empty() ? "" : "; ") + *l;
    return text.empty() ? "at the start" : "after " + text;
  }

  void violate(std::size_t v, const std::string& what) {
    if (result_.violation.empty()) result_.violation = what + ", " + path(v);
  }

  void count_state() {
    if (++result_.states > limit_)
      throw Error(ErrorCode::LimitReached,
                  "more than " + std::to_string(limit_) + " states to replay");
    if (progress_) progress_(result_.states);
  }

  void visit(Index node, RuntimeKnowledge k, std::size_t parent, std::string label) {
    if (depth_first_) {
      arrivals_.push_back({node, std::move(k), std::move(label)});
      return;
    }
    if (!live_.at(node).all) k.restrict_to(live_.at(node).facts);
    if (!seen_.emplace(node, live_.residue(node, k, {})).second) return;
    count_state();
    queue_.emplace_back(visits_.size(), std::move(k));
    visits_.push_back({node, nullptr, parent, std::move(label)});
  }

  /// A state that a node is reached in.
  struct Arrival {
    Index node;
    RuntimeKnowledge state;
    std::string label;
  };
  /// One that is being replayed.
  struct Open {
    Index node;
    RuntimeKnowledge state;
    std::size_t visit;
    std::set<Fact> read = {};  ///< by external functions, here and further down
    std::vector<Arrival> next = {};
    std::size_t at = 0;  ///< of `next`
  };
  /// States in which a node was replayed, as far as that rests on them.
  struct Replayed {
    std::set<Fact> read;  ///< by external functions
    std::set<LiveFacts::Residue> states;
  };

  /// External functions answer alike wherever what they asked of the state is alike.
  const Replayed* find_replayed(Index node, const RuntimeKnowledge& k) const {
    const auto at = replayed_.find(node);
    if (at == replayed_.end()) return nullptr;
    for (const Replayed& r : at->second)
      if (r.states.contains(live_.residue(node, k, r.read))) return &r;
    return nullptr;
  }

  void remember(Open& o) {
    std::vector<Replayed>& all = replayed_[o.node];
    const auto same = std::ranges::find(all, o.read, &Replayed::read);
    Replayed& r = same == all.end() ? all.emplace_back(Replayed{o.read, {}}) : *same;
    r.states.insert(live_.residue(o.node, std::move(o.state), r.read));
  }

  void replay_depth_first() {
    std::vector<Open> open;
    open.push_back({kNone, {}, kNoParent, {}, std::exchange(arrivals_, {})});
    while (!open.empty() && result_.violation.empty()) {
      Open& o = open.back();
      if (o.at < o.next.size()) {
        Arrival a = std::move(o.next[o.at++]);
        if (const Replayed* r = find_replayed(a.node, a.state)) {
          o.read.insert(r->read.begin(), r->read.end());
          continue;
        }
        count_state();
        Open deeper{a.node, std::move(a.state), visits_.size()};
        visits_.push_back({a.node, &deeper.state, o.visit, std::move(a.label)});
        evaluator_.note_reads(&deeper.read);
        replay(deeper.visit);
        evaluator_.note_reads(nullptr);
        deeper.next = std::exchange(arrivals_, {});
        open.push_back(std::move(deeper));
        continue;
      }
      if (o.visit != kNoParent) remember(o);
      if (open.size() > 1) open[open.size() - 2].read.insert(o.read.begin(), o.read.end());
      open.pop_back();
    }
  }

  void end(std::size_t v) {
    std::vector<Index> slots(std::max<Index>(model_.goal_slots, 1), 0);
    const bool holds = std::ranges::all_of(model_.goal.children, [&](const Query& q) {
      return evaluator_.holds(q, slots, *visits_[v].state);
    });
    ++result_.leaves;
    if (!holds) violate(v, "the goal does not hold at an end of the plan");
  }

  void replay(std::size_t v) {
    const Visit at = visits_[v];
    try {
      if (at.node == kNone)
        end(v);
      else
        carry_out(v);
    } catch (const LeftOpen& open) {
      // What stops a step was open before it: else the step would be done anew for ever, or never.
      ensure(at.state->is_open(open.fact), "what a step looks at was open before it");
      for (RuntimeKnowledge& k : transitions_.look_at(*at.state, open.fact))
        visit(at.node, std::move(k), at.parent, at.label);
    }
  }

  void carry_out(std::size_t v) {
    const Visit at = visits_[v];
    const Plan::Node& node = plan_.nodes[at.node];
    std::vector<RuntimeKnowledge> after;
    std::string label;
    if (node.acts) {
      label = action_text(model_, node.action);
      const Action& a = model_.actions[node.action.schema];
      std::vector<Index> slots = bind(a, node.action);
      if (!evaluator_.holds(a.precondition, slots, *at.state)) {
        violate(v, "the precondition of " + label + " does not hold");
        return;
      }
      if (!same_calls(v, node, evaluator_.calls(a.precondition, slots, *at.state))) return;
      after = transitions_.after(a, slots, *at.state);
      // What is observed rules a run out; but some run must get through, or it is no plan.
      if (after.empty()) {
        contradicted_.try_emplace(at.node, v);
        return;
      }
      passed_.insert(at.node);
    } else {
      after.push_back(*at.state);
    }
    for (RuntimeKnowledge& k : after) {
      kept_less_ |= k.cut();
      if (!node.branches) {
        visit(node.next, std::move(k), v, label);
        continue;
      }
      follow(v, node.branch, std::move(k), label);
    }
  }

  /// Whether external functions return what the plan says, paths and the like included.
  bool same_calls(std::size_t v, const Plan::Node& node, const std::vector<Plan::Call>& calls) {
    if (node.calls == calls) return true;
    const std::string action = action_text(model_, node.action);
    if (node.calls.size() != calls.size()) {
      violate(v, "the plan does not say what the calls of " + action + " return");
      return false;
    }
    for (std::size_t i = 0; i < calls.size(); ++i) {
      if (node.calls[i] == calls[i]) continue;
      const std::string name = model_.externals[calls[i].external].name;
      const bool same_value =
          node.calls[i].value == calls[i].value && node.calls[i].arguments == calls[i].arguments;
      std::string text = "for " + action + " the external function '";
      text.append(name).append("' returns ");
      if (same_value)
        text.append("another payload than the plan says");
      else
        text.append("'")
            .append(calls[i].value)
            .append("', not '")
            .append(node.calls[i].value)
            .append("' as the plan says");
      violate(v, text);
      return false;
    }
    return false;
  }

  void follow(std::size_t v, const Plan::Branch& branch, RuntimeKnowledge k,
              const std::string& label) {
    if (const Fact f = branch_fact(branch); k.is_open(f)) {
      for (RuntimeKnowledge& seen : transitions_.look_at(std::move(k), f))
        follow(v, branch, std::move(seen), label);
      return;
    }
    const Fact f = branch_fact(branch);
    const std::string prefix = label.empty() ? "" : label + "; ";
    Index value = 0;
    if (branch.function) {
      const Index* known = k.value(f);
      if (known == nullptr) {
        violate(v, prefix + "the plan branches on a value that is not known");
        return;
      }
      value = *known;
    } else {
      if (!k.knows_whether(f)) {
        violate(v, prefix + "the plan branches on " + case_text(model_, branch, 1) +
                       ", which is not known");
        return;
      }
      value = k.knows(f, true) ? 1 : 0;
    }
    for (const Plan::Branch::Case& c : branch.cases)
      if (c.value == value) {
        visit(c.next, std::move(k), v, prefix + "[" + case_text(model_, branch, value) + "]");
        return;
      }
    if (missing_ == MissingCases::Refused)
      violate(v, prefix + "the plan has no case for " + case_text(model_, branch, value));
  }

  const Model& model_;
  const Plan& plan_;
  std::uint64_t limit_;
  const CheckProgress& progress_;
  MissingCases missing_;
  QueryEvaluator evaluator_;
  LiveFacts live_;
  Transitions transitions_;
  std::set<std::pair<Index, LiveFacts::Residue>> seen_;
  std::vector<Visit> visits_;
  std::deque<std::pair<std::size_t, RuntimeKnowledge>> queue_;  ///< visits, and their states
  std::map<Index, std::size_t> contradicted_;  ///< nodes, and a visit in which they contradict
  std::set<Index> passed_;                     ///< nodes that some run gets through
  bool depth_first_;  ///< external functions may read anything: what they did is known afterwards
  std::vector<Arrival> arrivals_;
  std::map<Index, std::vector<Replayed>> replayed_;
  bool tried_at_once_ = false;
  bool kept_less_;
  CheckResult result_;
};

}  // namespace

CheckResult check(const Model& model, const Plan& plan, std::uint64_t limit,
                  const CheckProgress& progress, MissingCases missing) {
  measure(model, plan);  // refuses cycles
  Checker checker(model, plan, limit, progress, missing);
  CheckResult by_databases = checker.run();
  if (by_databases.valid || !checker.kept_less() || !WorldReplay::takes(model)) return by_databases;
  if (const auto by_worlds = WorldReplay(model, plan, limit, progress).run()) return *by_worlds;
  throw Error(ErrorCode::LimitReached,
              "the databases of knowledge do not confirm the plan (" + by_databases.violation +
                  "), and there are too many possible worlds to replay it on them");
}

}  // namespace kaboum::plan
