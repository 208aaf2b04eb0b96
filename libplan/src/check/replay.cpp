// A plan carried out: states of run-time knowledge, all or one of each node's outcomes.
#include <kaboum/base/error.h>
#include <kaboum/base/random.h>
#include <kaboum/plan/replay.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "check/live_facts.h"
#include "check/query_evaluator.h"
#include "check/runtime_knowledge.h"
#include "check/transitions.h"
#include "plan/named_fact.h"

namespace kaboum::plan {
namespace {

constexpr std::uint64_t kMostBranches = 1'000'000'000'000'000'000ULL;

KnownFacts::Term named(const Model& model, const QueryEvaluator& evaluator, const Fact& f) {
  const std::vector<Symbol>& symbols = f[0] == 1 ? model.functions : model.predicates;
  KnownFacts::Term out{symbols[f[1]].name};
  for (std::size_t i = 2; i < f.size(); ++i) out.push_back(evaluator.name(f[i]));
  return out;
}

class NamedKnowledge final : public KnownState {
 public:
  NamedKnowledge(const Model& model, const QueryEvaluator& evaluator, const RuntimeKnowledge& k)
      : model_(model), evaluator_(evaluator), k_(k) {}

  std::optional<std::string> value(const std::string& function,
                                   const std::vector<std::string>& arguments) const override {
    const auto symbol = std::ranges::find(model_.functions, function, &Symbol::name);
    if (symbol == model_.functions.end()) return std::nullopt;
    Fact f = {1, static_cast<Index>(symbol - model_.functions.begin())};
    for (const std::string& a : arguments) {
      const auto object = std::ranges::find(model_.objects, a, &Object::name);
      if (object == model_.objects.end()) return std::nullopt;
      f.push_back(static_cast<Index>(object - model_.objects.begin()));
    }
    const Index* v = k_.value(f);
    return v == nullptr ? std::nullopt : std::optional(evaluator_.name(*v));
  }

  KnownFacts facts() const override {
    const auto term = [&](const Fact& f) { return named(model_, evaluator_, f); };
    KnownFacts out;
    for (const auto& [f, truth] : k_.atoms()) out.atoms[term(f)] = truth;
    for (const auto& [f, value] : k_.values()) out.values[term(f)] = evaluator_.name(value);
    for (const auto& [f, values] : k_.excluded())
      for (const Index v : values) out.excluded[term(f)].insert(evaluator_.name(v));
    for (const auto& [entry, open] : k_.exclusive()) {
      out.exclusive.emplace_back();
      for (const Fact& f : open) out.exclusive.back().insert(term(f));
    }
    for (const std::set<FactLiteral>& literals : k_.some()) {
      out.some.emplace_back();
      for (const auto& [f, truth] : literals) out.some.back().emplace(term(f), truth);
    }
    out.cut = model_.cut || k_.cut();
    return out;
  }

 private:
  const Model& model_;
  const QueryEvaluator& evaluator_;
  const RuntimeKnowledge& k_;
};

class Run {
 public:
  Run(const Model& model, const Plan& plan, const RunOptions& options,
      const std::function<void(const RunStep&)>& step)
      : model_(model),
        plan_(plan),
        options_(options),
        step_(step),
        evaluator_(model, plan),
        live_(model, plan, evaluator_, LiveFacts::Sensing::Reads),
        transitions_(model, evaluator_, Transitions::Disjunctions::Kept),
        random_(options.seed),
        given_(given(model, options)) {}

  RunSummary run() {
    const std::vector<RuntimeKnowledge> first = transitions_.initial_states();
    if (options_.outcomes == RunOptions::Outcomes::All) {
      for (const RuntimeKnowledge& k : first) add(carry_out(plan_.root, k, 0));
    } else {
      if (options_.outcomes == RunOptions::Outcomes::Asked && first.size() != 1)
        throw Error(ErrorCode::InvalidInput,
                    "the problem begins in one of several states, and nobody can be asked which");
      carry_out(plan_.root, choose(first, nullptr), 0);
      summary_.branches = 1;
    }
    return summary_;
  }

 private:
  void add(std::uint64_t branches) {
    summary_.branches = std::min(kMostBranches, summary_.branches + branches);
  }

  /// What happens from a node on. @return ways through the plan.
  std::uint64_t carry_out(Index node, const RuntimeKnowledge& k, std::uint64_t actions) {
    const auto [at, fresh] = seen_.try_emplace({node, part_that_matters(node, k)}, 0);
    std::uint64_t& ways = at->second;
    if (!fresh) return ways;
    if (node == kNone) {
      ++summary_.ends;
      return ways = 1;
    }
    if (++summary_.states > options_.most_states)
      throw Error(ErrorCode::LimitReached, "the plan is carried out in more than " +
                                               std::to_string(options_.most_states) +
                                               " states: choose outcomes by a seed or a file");
    const Plan::Node& n = plan_.nodes[node];
    std::vector<RuntimeKnowledge> after{k};
    std::vector<Fact> sensed;
    if (n.acts) {
      std::vector<Index> slots = bind(model_.actions[n.action.schema], n.action);
      std::size_t used = 0;
      bind_calls(model_.actions[n.action.schema].precondition, n, slots, used);
      if (used != n.calls.size()) missing(n);
      after = transitions_.after(model_.actions[n.action.schema], slots, k, &sensed);
    }
    std::erase_if(sensed, [&](const Fact& f) { return values_of(f, after).size() < 2; });
    if (options_.outcomes == RunOptions::Outcomes::Asked)
      ask(after, sensed, node, k);
    else if (options_.outcomes != RunOptions::Outcomes::All && !after.empty())
      after = {choose(after, &n)};
    for (const RuntimeKnowledge& then : after) {
      const auto [next, outcome] =
          n.branches ? follow(n.branch, then) : std::pair(std::optional(n.next), std::string());
      const NamedKnowledge before_names(model_, evaluator_, k),
          after_names(model_, evaluator_, then);
      RunStep step{node, before_names, after_names, next.value_or(kNone), outcome, actions};
      for (const Fact& f : sensed) step.sensed.push_back({fact_text(f), value_of(f, then)});
      if (n.branches) {
        const Fact f = branch_fact(n.branch);
        step.decides = SensedValue{fact_text(f), value_of(f, then)};
        step.unplanned = !next;
      }
      step_(step);
      const std::uint64_t done = actions + (n.acts ? 1 : 0);
      if (!next) {
        options_.unplanned({outcome, after_names.facts(), done});
        ways = std::min(kMostBranches, ways + 1);
        continue;
      }
      ways = std::min(kMostBranches, ways + carry_out(*next, then, done));
    }
    return ways;
  }

  /// Of a state, what its way on from a node depends on and may be asked about: two that agree on
  /// it are carried out alike. Who is told of what the plan has no branch for is told all.
  RuntimeKnowledge part_that_matters(Index node, RuntimeKnowledge k) const {
    if (options_.unplanned || live_.at(node).all) return k;
    std::set<Fact> facts = live_.at(node).facts;
    for (const auto& [term, value] : k.values()) facts.insert(term);
    for (const auto& [term, values] : k.excluded()) facts.insert(term);
    k.restrict_to(facts);
    return k;
  }

  [[noreturn]] void missing(const Plan::Node& n) const {
    throw Error(ErrorCode::InvalidInput, "the plan does not say what the calls of " +
                                             action_text(model_, n.action) + " return");
  }

  /// Gives the slots of `let` what the plan says that the calls returned.
  void bind_calls(const Query& q, const Plan::Node& n, std::vector<Index>& slots,
                  std::size_t& used) const {
    if (q.kind == Query::Kind::And)
      for (const Query& c : q.children) bind_calls(c, n, slots, used);
    if (q.kind != Query::Kind::Let) return;
    if (used >= n.calls.size() || n.calls[used].external != q.symbol) missing(n);
    slots.at(q.value->index) =
        evaluator_.named(model_.externals[q.symbol].range, n.calls[used].value);
    ++used;
  }

  /// Where a branch goes, nullopt: it has no case for what was sensed; and what that says.
  std::pair<std::optional<Index>, std::string> follow(const Plan::Branch& b,
                                                      const RuntimeKnowledge& k) const {
    const Fact f = branch_fact(b);
    const Index* known = b.function ? k.value(f) : nullptr;
    if (b.function ? known == nullptr : !k.knows_whether(f))
      throw Error(ErrorCode::InvalidInput, "the plan branches on what is not known: " +
                                               case_text(model_, b, b.cases.front().value));
    const Index value = b.function ? *known : k.knows(f, true) ? 1 : 0;
    for (const Plan::Branch::Case& c : b.cases)
      if (c.value == value) return {c.next, case_text(model_, b, value)};
    if (options_.unplanned) return {std::nullopt, case_text(model_, b, value)};
    throw Error(ErrorCode::InvalidInput, "the plan has no case for " + case_text(model_, b, value));
  }

  /// One of several outcomes, as options have it.
  RuntimeKnowledge choose(const std::vector<RuntimeKnowledge>& all, const Plan::Node* node) {
    std::vector<std::size_t> fitting;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (fits(all[i])) fitting.push_back(i);
    if (fitting.empty())
      throw Error(ErrorCode::InvalidInput,
                  "the outcomes that were given contradict what is known" +
                      (node != nullptr && node->acts ? " after " + action_text(model_, node->action)
                                                     : std::string(" at the start")));
    return all[fitting[random_.index(fitting.size())]];
  }

  /// Leaves one of several states: what was sensed is asked for. A fact that is known by then,
  /// from before or from what another one has turned out to be, is not.
  void ask(std::vector<RuntimeKnowledge>& all, const std::vector<Fact>& sensed, Index node,
           const RuntimeKnowledge& before) const {
    const NamedKnowledge names(model_, evaluator_, before);
    for (const Fact& f : sensed) {
      const SensedFact question{node, names, fact_text(f), values_of(f, all)};
      if (question.values.size() < 2) continue;
      const std::string said = options_.sense(question);
      std::erase_if(all, [&](const RuntimeKnowledge& k) { return value_of(f, k) != said; });
      if (!all.empty()) continue;
      std::string what = question.fact;
      what += " was sensed to be '";
      what += said;
      what += "', and by what is known it is one of ";
      for (const std::string& v : question.values) {
        if (v != question.values.front()) what += ", ";
        what += v;
      }
      throw Error(ErrorCode::InvalidInput, what);
    }
    if (all.size() > 1) all.erase(all.begin() + 1, all.end());
  }

  /// @pre it is known
  [[nodiscard]] std::string value_of(const Fact& f, const RuntimeKnowledge& k) const {
    if (f[0] == 1) return evaluator_.name(*k.value(f));
    return k.knows(f, true) ? "true" : "false";
  }

  /// That a fact has in some states, each once.
  [[nodiscard]] std::vector<std::string> values_of(const Fact& f,
                                                   const std::vector<RuntimeKnowledge>& all) const {
    std::vector<std::string> out;
    for (const RuntimeKnowledge& k : all)
      if (std::string value = value_of(f, k); std::ranges::find(out, value) == out.end())
        out.push_back(std::move(value));
    return out;
  }

  /// "isSpillable(o1)".
  [[nodiscard]] std::string fact_text(const Fact& f) const {
    return text_of(named(model_, evaluator_, f));
  }

  /// Whether what is known is as given.
  bool fits(const RuntimeKnowledge& k) const {
    return std::ranges::all_of(given_, [&](const auto& entry) {
      const auto& [f, value] = entry;
      if (f[0] == 1) {
        const Index* v = k.value(f);
        return v == nullptr || evaluator_.name(*v) == value;
      }
      return !k.knows_whether(f) || k.knows(f, value == "true");
    });
  }

  /// The outcomes that are given, and their values.
  [[nodiscard]] static std::map<Fact, std::string> given(const Model& model,
                                                         const RunOptions& options) {
    std::map<Fact, std::string> out;
    if (options.outcomes != RunOptions::Outcomes::Given) return out;
    for (const auto& [text, value] : options.given) {
      const NamedFact named =
          read_named_fact(model, text, value, [&name = text](const std::string& what) {
            std::string said = "an outcome is given for '";
            said.append(name).append("', ").append(what);
            throw Error(ErrorCode::InvalidInput, said);
          });
      Fact f = {named.function ? Index{1} : Index{0}, named.symbol};
      f.insert(f.end(), named.arguments.begin(), named.arguments.end());
      out[f] = value;
    }
    return out;
  }

  const Model& model_;
  const Plan& plan_;
  const RunOptions& options_;
  const std::function<void(const RunStep&)>& step_;
  QueryEvaluator evaluator_;
  LiveFacts live_;
  Transitions transitions_;
  Random random_;
  std::map<Fact, std::string> given_;
  std::map<std::pair<Index, RuntimeKnowledge>, std::uint64_t> seen_;
  RunSummary summary_;
};

}  // namespace

RunSummary run(const Model& model, const Plan& plan, const RunOptions& options,
               const std::function<void(const RunStep&)>& step) {
  measure(model, plan);  // refuses cycles
  return Run(model, plan, options, step).run();
}

}  // namespace kaboum::plan
