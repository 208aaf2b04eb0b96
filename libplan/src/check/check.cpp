// The validator. It reads the lifted model and replays; nothing of the planner is included here.
#include <kaboum/geom/error.h>
#include <kaboum/plan/check.h>

#include <algorithm>
#include <deque>
#include <map>
#include <optional>
#include <utility>

#include "check/runtime_knowledge.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumSplit = 1U << 16U;  // outcomes of one action

Fact fact(bool function, Index symbol, const std::vector<Argument>& arguments,
          const std::vector<Index>& slots) {
  Fact f = {function ? Index{1} : Index{0}, symbol};
  for (const Argument& a : arguments) f.push_back(a.variable ? slots.at(a.index) : a.index);
  return f;
}

Index object(const Argument& a, const std::vector<Index>& slots) {
  return a.variable ? slots.at(a.index) : a.index;
}

/// Evaluates queries of the lifted model, or lists what they read.
class Evaluator {
 public:
  explicit Evaluator(const Model& model) : model_(model) {}

  bool holds(const Query& q, std::vector<Index>& slots, const RuntimeKnowledge& k) const {
    switch (q.kind) {
      case Query::Kind::True:
        return true;
      case Query::Kind::False:
        return false;
      case Query::Kind::And:
        return std::all_of(q.children.begin(), q.children.end(),
                           [&](const Query& c) { return holds(c, slots, k); });
      case Query::Kind::Or:
        return std::any_of(q.children.begin(), q.children.end(),
                           [&](const Query& c) { return holds(c, slots, k); });
      case Query::Kind::Xor:
        return std::count_if(q.children.begin(), q.children.end(),
                             [&](const Query& c) { return holds(c, slots, k); }) == 1;
      case Query::Kind::Not:
        return !holds(q.children[0], slots, k);
      case Query::Kind::Exists:
      case Query::Kind::ForAll:
        for (const Index o : model_.types[q.type].objects) {
          slots.at(q.symbol) = o;
          if (holds(q.children[0], slots, k) == (q.kind == Query::Kind::Exists))
            return q.kind == Query::Kind::Exists;
        }
        return q.kind == Query::Kind::ForAll;
      case Query::Kind::Known:
        return k.knows(fact(false, q.symbol, q.arguments, slots), !q.negated);
      case Query::Kind::KnowWhether:
        return k.knows_whether(fact(false, q.symbol, q.arguments, slots));
      case Query::Kind::KnownValue:
      case Query::Kind::WhetherValue: {
        const Fact f = fact(true, q.symbol, q.arguments, slots);
        const Index wanted = object(*q.value, slots);
        const Index* value = k.value(f);
        const bool differs =
            !model_.is_a(wanted, model_.functions[q.symbol].range) || k.rules_out(f, wanted);
        if (q.kind == Query::Kind::WhetherValue) return value != nullptr || differs;
        return q.negated ? differs : value != nullptr && *value == wanted;
      }
      case Query::Kind::KnowValue:
        return k.value(fact(true, q.symbol, q.arguments, slots)) != nullptr;
      case Query::Kind::Same:
        return object(q.arguments[0], slots) == object(q.arguments[1], slots);
      case Query::Kind::External: {
        std::vector<Index> arguments;
        for (const Argument& a : q.arguments) arguments.push_back(object(a, slots));
        const auto result = call(q.symbol, std::move(arguments));
        return result && (!q.value || *result == object(*q.value, slots));
      }
    }
    throw Error(ErrorCode::Internal, "unexpected query");
  }

  void reads(const Query& q, std::vector<Index>& slots, std::set<Fact>& out) const {
    switch (q.kind) {
      case Query::Kind::Known:
      case Query::Kind::KnowWhether:
        out.insert(fact(false, q.symbol, q.arguments, slots));
        return;
      case Query::Kind::KnownValue:
      case Query::Kind::WhetherValue:
      case Query::Kind::KnowValue:
        out.insert(fact(true, q.symbol, q.arguments, slots));
        return;
      case Query::Kind::Exists:
      case Query::Kind::ForAll:
        for (const Index o : model_.types[q.type].objects) {
          slots.at(q.symbol) = o;
          reads(q.children[0], slots, out);
        }
        return;
      default:
        for (const Query& c : q.children) reads(c, slots, out);
    }
  }

  /// Another state: volatile functions are called again.
  void forget_calls() {
    std::erase_if(calls_,
                  [&](const auto& c) { return model_.externals[c.first.first].is_volatile; });
  }

 private:
  std::optional<Index> call(Index external, std::vector<Index> arguments) const {
    const auto [it, fresh] = calls_.try_emplace({external, std::move(arguments)});
    if (fresh) it->second = model_.external_functions[external](it->first.second);
    return it->second;
  }

  const Model& model_;
  mutable std::map<std::pair<Index, std::vector<Index>>, std::optional<Index>> calls_;
};

class Checker {
 public:
  Checker(const Model& model, const Plan& plan, std::uint64_t limit)
      : model_(model), plan_(plan), limit_(limit), evaluator_(model) {}

  CheckResult run() {
    measure(model_, plan_);  // refuses cycles
    find_live();
    std::vector<RuntimeKnowledge> starts = initial_states();
    for (RuntimeKnowledge& k : starts) visit(plan_.root, std::move(k), kNoParent, "");
    while (!queue_.empty() && result_.violation.empty()) {
      const std::size_t v = queue_.front();
      queue_.pop_front();
      replay(v);
    }
    for (const auto& [node, v] : contradicted_)
      if (!passed_.contains(node))
        violate(v, "what " + step_text(model_, plan_.nodes[node].action) +
                       " observes contradicts what is known");
    result_.valid = result_.violation.empty();
    return result_;
  }

 private:
  static constexpr std::size_t kNoParent = ~std::size_t{0};

  struct Visit {
    Index node;
    const RuntimeKnowledge* state;
    std::size_t parent;
    std::string label;
  };

  // ---- what each node and its successors read ----------------------------------------------
  void find_live() {
    std::vector<Index> slots(std::max<Index>(model_.goal_slots, 1), 0);
    evaluator_.reads(model_.goal, slots, goal_reads_);
    live_.resize(plan_.nodes.size());
    std::vector<char> done(plan_.nodes.size(), 0);
    // Acyclic: repeat over a stack until successors are done.
    std::vector<Index> stack;
    if (plan_.root != kNone) stack.push_back(plan_.root);
    while (!stack.empty()) {
      const Index n = stack.back();
      const Plan::Node& node = plan_.nodes[n];
      std::vector<Index> next;
      if (!node.branches) next.push_back(node.next);
      for (const Plan::Branch::Case& c : node.branch.cases) next.push_back(c.next);
      bool ready = true;
      for (const Index m : next)
        if (m != kNone && !done[m]) {
          stack.push_back(m);
          ready = false;
        }
      if (!ready) continue;
      stack.pop_back();
      if (done[n]) continue;
      done[n] = 1;
      std::set<Fact>& live = live_[n];
      for (const Index m : next) {
        const std::set<Fact>& below = m == kNone ? goal_reads_ : live_[m];
        live.insert(below.begin(), below.end());
      }
      if (node.branches) live.insert(branch_fact(node.branch));
      if (node.acts) {
        const Action& a = model_.actions[node.action.schema];
        std::vector<Index> bound = bind(a, node.action);
        evaluator_.reads(a.precondition, bound, live);
        for (const Effect& e : a.effects) effect_reads(e, bound, live);
      }
    }
  }

  void effect_reads(const Effect& e, std::vector<Index>& slots, std::set<Fact>& out) const {
    if (e.kind == Effect::Kind::When) evaluator_.reads(e.condition, slots, out);
    // A disjunction combines with what is known of its atoms by then.
    if (e.kind == Effect::Kind::Update && e.update.database == Update::Database::Kx)
      for (const Update::Literal& l : e.update.literals)
        out.insert(fact(l.function, l.symbol, l.arguments, slots));
    if (e.kind == Effect::Kind::ForAll) {
      for (const Index o : model_.types[e.type].objects) {
        slots.at(e.slot) = o;
        for (const Effect& c : e.children) effect_reads(c, slots, out);
      }
      return;
    }
    for (const Effect& c : e.children) effect_reads(c, slots, out);
  }

  static Fact branch_fact(const Plan::Branch& b) {
    Fact f = {b.function ? Index{1} : Index{0}, b.symbol};
    f.insert(f.end(), b.arguments.begin(), b.arguments.end());
    return f;
  }

  static std::vector<Index> bind(const Action& a, const Plan::Step& step) {
    std::vector<Index> slots(std::max<Index>(a.slots, 1), 0);
    std::copy(step.arguments.begin(), step.arguments.end(), slots.begin());
    return slots;
  }

  // ---- knowledge ---------------------------------------------------------------------------
  [[nodiscard]] const std::vector<Index>& range(Index function) const {
    return model_.types[model_.functions[function].range].objects;
  }

  /// The states that the sensing of these facts may lead to.
  std::vector<RuntimeKnowledge> split(RuntimeKnowledge k, const std::vector<Fact>& sensed) const {
    std::vector<RuntimeKnowledge> all;
    all.push_back(std::move(k));
    for (const Fact& f : sensed) {
      std::vector<RuntimeKnowledge> next;
      for (RuntimeKnowledge& state : all) {
        if (f[0] == 1 ? state.value(f) != nullptr : state.knows_whether(f)) {
          next.push_back(std::move(state));
          continue;
        }
        if (f[0] == 1) {
          for (const Index v : range(f[1])) {
            RuntimeKnowledge copy = state;
            if (!state.rules_out(f, v) && copy.learn_value(f, v, range(f[1])))
              next.push_back(std::move(copy));
          }
        } else {
          for (const bool truth : {true, false}) {
            RuntimeKnowledge copy = state;
            if (copy.learn(f, truth)) next.push_back(std::move(copy));
          }
        }
      }
      if (next.size() > kMaximumSplit)
        throw Error(ErrorCode::LimitReached, "too many outcomes of one action to replay");
      all = std::move(next);
    }
    return all;
  }

  std::vector<RuntimeKnowledge> initial_states() const {
    RuntimeKnowledge k;
    std::vector<Fact> sensed;
    std::set<Fact> stated;
    const std::vector<Index> none;
    for (const Update& u : model_.initial) {
      const Update::Literal& l = u.literals[0];
      const Fact f = fact(l.function, l.symbol, l.arguments, none);
      bool ok = true;
      switch (u.database) {
        case Update::Database::Kf:
          if (!l.function) {
            ok = k.learn(f, !l.negated);
          } else {
            ok = l.negated ? k.learn_not_value(f, l.value->index, range(l.symbol))
                           : k.learn_value(f, l.value->index, range(l.symbol));
          }
          break;
        case Update::Database::Kw:
        case Update::Database::Kv:
          sensed.push_back(f);
          stated.insert(f);
          break;
        case Update::Database::Kx:
          for (const Update::Literal& o : u.literals)
            stated.insert(fact(o.function, o.symbol, o.arguments, none));
          ok = learn_exclusive(k, u, none);
          break;
        case Update::Database::Lcw:
          // Closed last: what is sensed or in a disjunction stays open.
          if (!k.knows_whether(f) && !stated.contains(f)) ok = k.learn(f, false);
          break;
      }
      if (!ok) throw Error(ErrorCode::InvalidInput, "the initial knowledge contradicts itself");
    }
    return split(std::move(k), sensed);
  }

  bool learn_exclusive(RuntimeKnowledge& k, const Update& u,
                       const std::vector<Index>& slots) const {
    if (!u.literals[0].function) {
      std::set<Fact> atoms;
      for (const Update::Literal& l : u.literals)
        atoms.insert(fact(false, l.symbol, l.arguments, slots));
      return k.learn_exclusive(atoms);
    }
    const Index symbol = u.literals[0].symbol;
    const Fact f = fact(true, symbol, u.literals[0].arguments, slots);
    std::set<Index> options;
    for (const Update::Literal& l : u.literals) options.insert(object(*l.value, slots));
    for (const Index v : range(symbol))
      if (!options.contains(v) && !k.learn_not_value(f, v, range(symbol))) return false;
    return true;
  }

  struct Ground {
    const Update* update;
    std::vector<Index> slots;
  };

  /// Updates whose conditions hold before the action.
  void fire(const std::vector<Effect>& effects, std::vector<Index>& slots,
            const RuntimeKnowledge& k, std::vector<Ground>& out) const {
    for (const Effect& e : effects) {
      if (e.kind == Effect::Kind::Update) {
        out.push_back({&e.update, slots});
      } else if (e.kind == Effect::Kind::When) {
        if (evaluator_.holds(e.condition, slots, k)) fire(e.children, slots, k, out);
      } else {
        for (const Index o : model_.types[e.type].objects) {
          slots.at(e.slot) = o;
          fire(e.children, slots, k, out);
        }
      }
    }
  }

  [[nodiscard]] bool in_range(const Update::Literal& l, const std::vector<Index>& slots) const {
    const Symbol& s = (l.function ? model_.functions : model_.predicates)[l.symbol];
    for (std::size_t i = 0; i < l.arguments.size(); ++i)
      if (!model_.is_a(object(l.arguments[i], slots), s.parameters[i])) return false;
    return !l.value || model_.is_a(object(*l.value, slots), s.range);
  }

  void delete_from(RuntimeKnowledge& k, const Ground& g) const {
    const Update& u = *g.update;
    const Update::Literal& l = u.literals[0];
    const Fact f = fact(l.function, l.symbol, l.arguments, g.slots);
    switch (u.database) {
      case Update::Database::Kf:
        if (!l.function) {
          if (!k.knows(f, l.negated)) k.forget(f);
        } else if (l.negated) {
          const Index* v = k.value(f);
          if (v == nullptr || *v != object(*l.value, g.slots)) k.forget_value(f);
        } else if (!k.rules_out(f, object(*l.value, g.slots))) {
          k.forget_value(f);
        }
        return;
      case Update::Database::Kw:
        k.forget(f);
        return;
      case Update::Database::Kv:
        k.forget_value(f);
        return;
      case Update::Database::Kx:
        if (l.function) {
          k.forget_value(f);
        } else {
          std::set<Fact> atoms;
          for (const Update::Literal& o : u.literals)
            atoms.insert(fact(false, o.symbol, o.arguments, g.slots));
          k.drop_exclusive(atoms);
        }
        return;
      case Update::Database::Lcw:
        if (!k.knows(f, true)) k.forget(f);
        return;
    }
  }

  /// @return false if it is an observation that contradicts what is known.
  bool add_to(RuntimeKnowledge& k, const Ground& g, std::vector<Fact>& sensed) const {
    const Update& u = *g.update;
    const Update::Literal& l = u.literals[0];
    const Fact f = fact(l.function, l.symbol, l.arguments, g.slots);
    switch (u.database) {
      case Update::Database::Kf:
        if (u.maybe) {
          may_become(k, f, l, g.slots);
        } else if (!l.function) {
          k.become(f, !l.negated);
        } else if (!l.negated) {
          k.become_value(f, object(*l.value, g.slots));
        } else {
          const Index v = object(*l.value, g.slots);
          if (const Index* known = k.value(f); known != nullptr && *known == v) k.forget_value(f);
          return k.learn_not_value(f, v, range(l.symbol));
        }
        return true;
      case Update::Database::Kw:
      case Update::Database::Kv:
      case Update::Database::Lcw:
        sensed.push_back(f);
        return true;
      case Update::Database::Kx:
        if (l.function) {
          const Index* known = k.value(f);
          const bool kept = known == nullptr ||
                            std::any_of(u.literals.begin(), u.literals.end(), [&](const auto& o) {
                              return object(*o.value, g.slots) == *known;
                            });
          if (!kept) k.forget_value(f);
        }
        return learn_exclusive(k, u, g.slots);
    }
    return true;
  }

  /// The literal may have come true: it stays known if it was, and its negation does not.
  void may_become(RuntimeKnowledge& k, const Fact& f, const Update::Literal& l,
                  const std::vector<Index>& slots) const {
    if (!l.function) {
      if (!k.knows(f, !l.negated)) k.forget(f);
      return;
    }
    const Index v = object(*l.value, slots);
    const Index* known = k.value(f);
    const bool holds = l.negated ? k.rules_out(f, v) : known != nullptr && *known == v;
    if (!holds) k.forget_value(f);
  }

  // ---- replay ------------------------------------------------------------------------------
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

  void visit(Index node, RuntimeKnowledge k, std::size_t parent, std::string label) {
    k.restrict_to(node == kNone ? goal_reads_ : live_[node]);
    const auto [it, fresh] = seen_.emplace(node, std::move(k));
    if (!fresh) return;
    if (++result_.states > limit_)
      throw Error(ErrorCode::LimitReached,
                  "more than " + std::to_string(limit_) + " states to replay");
    visits_.push_back({node, &it->second, parent, std::move(label)});
    queue_.push_back(visits_.size() - 1);
  }

  void replay(std::size_t v) {
    const Visit at = visits_[v];
    evaluator_.forget_calls();  // within one state, each is called once
    if (at.node == kNone) {
      ++result_.leaves;
      std::vector<Index> slots(std::max<Index>(model_.goal_slots, 1), 0);
      for (const Query& q : model_.goal.children)
        if (!evaluator_.holds(q, slots, *at.state)) {
          violate(v, "the goal does not hold at an end of the plan");
          return;
        }
      return;
    }
    const Plan::Node& node = plan_.nodes[at.node];
    std::vector<RuntimeKnowledge> after;
    std::string label;
    if (node.acts) {
      label = step_text(model_, node.action);
      const Action& a = model_.actions[node.action.schema];
      std::vector<Index> slots = bind(a, node.action);
      if (!evaluator_.holds(a.precondition, slots, *at.state)) {
        violate(v, "the precondition of " + label + " does not hold");
        return;
      }
      std::vector<Ground> fired;
      fire(a.effects, slots, *at.state, fired);
      std::erase_if(fired, [&](const Ground& g) {
        return !std::all_of(g.update->literals.begin(), g.update->literals.end(),
                            [&](const Update::Literal& l) { return in_range(l, g.slots); });
      });
      RuntimeKnowledge k = *at.state;
      std::vector<Fact> sensed;
      for (const Ground& g : fired)
        if (!g.update->add) delete_from(k, g);
      bool possible = true;
      for (const Ground& g : fired)
        if (g.update->add) possible = possible && add_to(k, g, sensed);
      // What is observed rules this run out; but some run must get through, or it is no plan.
      if (possible) after = split(std::move(k), sensed);
      if (after.empty()) {
        contradicted_.try_emplace(at.node, v);
        return;
      }
      passed_.insert(at.node);
    } else {
      after.push_back(*at.state);
    }
    for (RuntimeKnowledge& k : after) {
      if (!node.branches) {
        visit(node.next, std::move(k), v, label);
        continue;
      }
      follow(v, node.branch, std::move(k), label);
    }
  }

  void follow(std::size_t v, const Plan::Branch& branch, RuntimeKnowledge k,
              const std::string& label) {
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
    violate(v, prefix + "the plan has no case for " + case_text(model_, branch, value));
  }

  const Model& model_;
  const Plan& plan_;
  std::uint64_t limit_;
  Evaluator evaluator_;
  std::set<Fact> goal_reads_;
  std::vector<std::set<Fact>> live_;
  std::set<std::pair<Index, RuntimeKnowledge>> seen_;
  std::vector<Visit> visits_;
  std::deque<std::size_t> queue_;
  std::map<Index, std::size_t> contradicted_;  ///< nodes, and a visit in which they contradict
  std::set<Index> passed_;                     ///< nodes that some run gets through
  CheckResult result_;
};

}  // namespace

CheckResult check(const Model& model, const Plan& plan, std::uint64_t limit) {
  return Checker(model, plan, limit).run();
}

}  // namespace kaboum::plan
