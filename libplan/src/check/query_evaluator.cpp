// Queries evaluated on the lifted model, one object after another.
#include "check/query_evaluator.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <exception>

#include "check/derived_facts.h"

namespace kaboum::plan {

Fact fact(bool function, Index symbol, const std::vector<Argument>& arguments,
          const std::vector<Index>& slots) {
  Fact f = {function ? Index{1} : Index{0}, symbol};
  for (const Argument& a : arguments) f.push_back(a.variable ? slots.at(a.index) : a.index);
  return f;
}

namespace {

/// What a state of knowledge answers to an external function. What it is asked can be noted.
class KnowledgeReader final : public StateReader {
 public:
  KnowledgeReader(const RuntimeKnowledge& k, std::set<Fact>* noted) : k_(k), noted_(noted) {}
  std::optional<Index> value(Index function, std::span<const Index> arguments) override {
    const Fact f = asked(1, function, arguments);
    const Index* v = k_.value(f);
    return v == nullptr ? std::nullopt : std::optional<Index>(*v);
  }
  std::optional<bool> truth(Index predicate, std::span<const Index> arguments) override {
    const Fact f = asked(0, predicate, arguments);
    if (!k_.knows_whether(f)) return std::nullopt;
    return k_.knows(f, true);
  }

 private:
  Fact asked(Index kind, Index symbol, std::span<const Index> arguments) {
    Fact f = {kind, symbol};
    f.insert(f.end(), arguments.begin(), arguments.end());
    if (noted_ != nullptr) noted_->insert(f);
    return f;
  }
  const RuntimeKnowledge& k_;
  std::set<Fact>* noted_;
};

}  // namespace

QueryEvaluator::QueryEvaluator(const Model& model, const Plan& plan)
    : model_(model),
      seed_(plan.seed),
      attempts_(std::max(plan.attempts, 1U)),
      choices_(plan.choices),
      handles_(static_cast<Index>(model.objects.size())) {}

std::optional<bool> QueryEvaluator::truth(const Query& q, std::vector<Index>& slots,
                                          const RuntimeKnowledge& k) const {
  if (derived_ == nullptr && !model_.rules.empty())
    return with_derived(k, [&] { return truth(q, slots, k); });
  switch (q.kind) {
    case Query::Kind::True:
      return true;
    case Query::Kind::False:
      return false;
    case Query::Kind::And:
    case Query::Kind::Or: {
      const bool decides = q.kind == Query::Kind::Or;
      std::optional<bool> result = !decides;
      for (const Query& c : q.children) {
        const std::optional<bool> t = truth(c, slots, k);
        if (t == decides) return decides;
        if (!t) result = std::nullopt;
        if (!t && !decides) return std::nullopt;  // what comes later is not asked
      }
      return result;
    }
    case Query::Kind::Xor: {
      std::optional<bool> result = false;
      for (const Query& c : q.children) {
        const std::optional<bool> alone = only(q, c, slots, k);
        if (alone == true) return true;
        if (!alone) result = std::nullopt;
      }
      return result;
    }
    case Query::Kind::Not:
      return denied(q.children[0], slots, k);
    case Query::Kind::Exists:
    case Query::Kind::ForAll: {
      const bool decides = q.kind == Query::Kind::Exists;
      std::optional<bool> result = !decides;
      for (const Index o : model_.types[q.type].objects) {
        slots.at(q.symbol) = o;
        const std::optional<bool> t = truth(q.children[0], slots, k);
        if (t == decides) return decides;
        if (!t) result = std::nullopt;
      }
      return result;
    }
    case Query::Kind::Known:
      return k.knows(fact(false, q.symbol, q.arguments, slots), !q.negated);
    case Query::Kind::KnowWhether:
      return k.knows_whether(fact(false, q.symbol, q.arguments, slots));
    case Query::Kind::KnownValue:
    case Query::Kind::WhetherValue:
      return holds_of_value(q, slots, k);
    case Query::Kind::KnowValue:
      return k.value(fact(true, q.symbol, q.arguments, slots)) != nullptr;
    case Query::Kind::Derived:
      return derived(q, slots) != q.negated;
    case Query::Kind::Same:
      return object(q.arguments[0], slots) == object(q.arguments[1], slots);
    case Query::Kind::External:
    case Query::Kind::Let: {
      const ExternalResult result = call(q, slots, k);
      if (result.kind == Answer::Kind::NotFound) return std::nullopt;
      if (result.kind == Answer::Kind::Impossible) return false;
      if (q.kind == Query::Kind::Let) {
        slots.at(q.value->index) = result.value;
        return true;
      }
      return !q.value || result.value == object(*q.value, slots);
    }
  }
  throw Error(ErrorCode::Internal, "unexpected query");
}

std::optional<bool> QueryEvaluator::denied(const Query& q, std::vector<Index>& slots,
                                           const RuntimeKnowledge& k) const {
  if (derived_ == nullptr && !model_.rules.empty())
    return with_derived(k, [&] { return denied(q, slots, k); });
  // false: not all of them, true: one of them; nullopt where that is not found.
  const auto of = [&](bool one, const auto& parts, const auto& denies) {
    std::optional<bool> result = !one;
    for (const auto& part : parts) {
      const std::optional<bool> t = denies(part);
      if (t == one) return std::optional<bool>(one);
      if (!t) result = std::nullopt;
    }
    return result;
  };
  const auto child = [&](const Query& c) { return denied(c, slots, k); };
  switch (q.kind) {
    case Query::Kind::And:
      return of(true, q.children, child);
    case Query::Kind::Or:
      return of(false, q.children, child);
    case Query::Kind::Not:
      return truth(q.children[0], slots, k);
    case Query::Kind::Xor:  // none is the only one
      return of(false, q.children, [&](const Query& c) -> std::optional<bool> {
        const std::optional<bool> t = denied(c, slots, k);
        if (t == true) return t;
        const auto another = [&](const Query& other) -> std::optional<bool> {
          return &other == &c ? std::optional<bool>(false) : truth(other, slots, k);
        };
        const std::optional<bool> more = of(true, q.children, another);
        return more == true ? more : t && more ? std::optional<bool>(false) : std::nullopt;
      });
    case Query::Kind::Exists:
    case Query::Kind::ForAll:
      return of(q.kind == Query::Kind::ForAll, model_.types[q.type].objects, [&](Index o) {
        slots.at(q.symbol) = o;
        return child(q.children[0]);
      });
    case Query::Kind::External: {
      for (const Argument& a : q.arguments)
        if (!value(a, slots, k)) return false;  // it says nothing
      const std::optional<bool> t = truth(q, slots, k);
      return t ? std::optional<bool>(!*t) : t;
    }
    default:
      return truth(q, slots, k) == false;
  }
}

std::optional<bool> QueryEvaluator::only(const Query& q, const Query& one,
                                         std::vector<Index>& slots,
                                         const RuntimeKnowledge& k) const {
  std::optional<bool> result = true;
  for (const Query& c : q.children) {
    const std::optional<bool> t = &c == &one ? truth(c, slots, k) : denied(c, slots, k);
    if (t == false) return false;
    if (!t) result = std::nullopt;
  }
  return result;
}

bool QueryEvaluator::derived(const Query& q, const std::vector<Index>& slots) const {
  return derived_->holds(fact(false, q.symbol, q.arguments, slots));
}

QueryEvaluator::Extent QueryEvaluator::extent(const Query& q, Subject of, std::vector<Index>& slots,
                                              const RuntimeKnowledge& k) const {
  const auto of_truth = [](std::optional<bool> t) {
    return !t ? Extent::SomeWorlds : *t ? Extent::EveryWorld : Extent::NoWorld;
  };
  switch (q.kind) {
    case Query::Kind::Known: {
      const Fact f = fact(false, q.symbol, q.arguments, slots);
      if (!k.knows_whether(f)) return Extent::SomeWorlds;
      return of_truth(k.knows(f, !q.negated));
    }
    case Query::Kind::KnownValue: {
      const Fact f = fact(true, q.symbol, q.arguments, slots);
      const Index c = object(*q.value, slots);
      if (!model_.is_a(c, model_.functions[q.symbol].range) || k.rules_out(f, c))
        return of_truth(q.negated);
      return k.value(f) == nullptr ? Extent::SomeWorlds : of_truth(!q.negated);
    }
    case Query::Kind::KnowWhether:
    case Query::Kind::WhetherValue:
    case Query::Kind::KnowValue:
      return of == Subject::World ? Extent::EveryWorld : of_truth(truth(q, slots, k));
    case Query::Kind::External:
    case Query::Kind::Let:
      // What it makes of a state in which more is known, nobody can say.
      if (model_.external_functions[q.symbol].reads_state) return Extent::SomeWorlds;
      for (const Argument& a : q.arguments)
        if (!value(a, slots, k)) return Extent::SomeWorlds;
      return of_truth(truth(q, slots, k));
    case Query::Kind::True:
    case Query::Kind::False:
    case Query::Kind::Same:
    case Query::Kind::Derived:  // where there are rules all is known
      return of_truth(truth(q, slots, k));
    default:
      return extent_of_children(q, of, slots, k);
  }
}

/// Of connectives and quantifiers: the least, the greatest, or the opposite of their parts.
QueryEvaluator::Extent QueryEvaluator::extent_of_children(const Query& q, Subject of,
                                                          std::vector<Index>& slots,
                                                          const RuntimeKnowledge& k) const {
  std::vector<Extent> parts;
  if (q.kind == Query::Kind::Exists || q.kind == Query::Kind::ForAll) {
    for (const Index o : model_.types[q.type].objects) {
      slots.at(q.symbol) = o;
      parts.push_back(extent(q.children[0], of, slots, k));
    }
  } else {
    for (const Query& c : q.children) parts.push_back(extent(c, of, slots, k));
  }
  switch (q.kind) {
    case Query::Kind::And:
    case Query::Kind::ForAll:
      return std::ranges::min(parts.empty() ? std::vector{Extent::EveryWorld} : parts);
    case Query::Kind::Or:
    case Query::Kind::Exists:
      return std::ranges::max(parts.empty() ? std::vector{Extent::NoWorld} : parts);
    case Query::Kind::Not:
      return parts[0] == Extent::SomeWorlds   ? parts[0]
             : parts[0] == Extent::EveryWorld ? Extent::NoWorld
                                              : Extent::EveryWorld;
    case Query::Kind::Xor: {
      const auto everywhere = std::ranges::count(parts, Extent::EveryWorld);
      if (everywhere > 1) return Extent::NoWorld;
      if (std::ranges::count(parts, Extent::SomeWorlds) > 0) return Extent::SomeWorlds;
      return everywhere == 1 ? Extent::EveryWorld : Extent::NoWorld;
    }
    default:
      throw Error(ErrorCode::Internal, "unexpected connective");
  }
}

template <class Evaluate>
std::optional<bool> QueryEvaluator::with_derived(const RuntimeKnowledge& k,
                                                 Evaluate&& evaluate) const {
  struct Reset {
    DerivedFacts*& at;
    ~Reset() { at = nullptr; }
  };
  DerivedFacts facts(model_, *this, k);
  const Reset reset{derived_};
  derived_ = &facts;
  return evaluate();
}

std::optional<Index> QueryEvaluator::value(const Argument& a, const std::vector<Index>& slots,
                                           const RuntimeKnowledge& k) const {
  if (!a.term) return object(a, slots);
  const Index* v = k.value(fact(true, a.term->function, a.term->arguments, slots));
  return v == nullptr ? std::nullopt : std::optional<Index>(*v);
}

/// K(f = c), K(f != c) or Kw(f = c).
bool QueryEvaluator::holds_of_value(const Query& q, const std::vector<Index>& slots,
                                    const RuntimeKnowledge& k) const {
  const Fact f = fact(true, q.symbol, q.arguments, slots);
  const Index wanted = object(*q.value, slots);
  const Index* value = k.value(f);
  const bool differs =
      !model_.is_a(wanted, model_.functions[q.symbol].range) || k.rules_out(f, wanted);
  if (q.kind == Query::Kind::WhetherValue) return value != nullptr || differs;
  return q.negated ? differs : value != nullptr && *value == wanted;
}

bool QueryEvaluator::reads(const Query& q, std::vector<Index>& slots, std::set<Fact>& out) const {
  switch (q.kind) {
    case Query::Kind::Known:
    case Query::Kind::KnowWhether:
      out.insert(fact(false, q.symbol, q.arguments, slots));
      return true;
    case Query::Kind::KnownValue:
    case Query::Kind::WhetherValue:
    case Query::Kind::KnowValue:
      out.insert(fact(true, q.symbol, q.arguments, slots));
      return true;
    case Query::Kind::Derived:
      return false;
    case Query::Kind::External:
    case Query::Kind::Let:
      for (const Argument& a : q.arguments)
        if (a.term) out.insert(fact(true, a.term->function, a.term->arguments, slots));
      return true;
    default:
      break;
  }
  bool listed = true;
  if (q.kind == Query::Kind::Exists || q.kind == Query::Kind::ForAll) {
    for (const Index o : model_.types[q.type].objects) {
      slots.at(q.symbol) = o;
      listed &= reads(q.children[0], slots, out);
    }
    return listed;
  }
  for (const Query& c : q.children) listed &= reads(c, slots, out);
  return listed;
}

std::vector<Plan::Call> QueryEvaluator::calls(const Query& q, std::vector<Index>& slots,
                                              const RuntimeKnowledge& k) const {
  std::vector<Plan::Call> all;
  if (q.kind == Query::Kind::And)
    for (const Query& c : q.children)
      for (Plan::Call& made : calls(c, slots, k)) all.push_back(std::move(made));
  if (q.kind != Query::Kind::Let) return all;
  std::vector<Index> arguments;
  ExternalResult result = call(q, slots, k, &arguments);
  Plan::Call made{q.symbol, {}, name(result.value), std::move(result.payload)};
  for (const Index a : arguments) made.arguments.push_back(name(a));
  all.push_back(std::move(made));
  return all;
}

Index QueryEvaluator::named(Index type, const std::string& name) const {
  for (const Index o : model_.types[type].objects)
    if (model_.objects[o].name == name) return o;
  if (!model_.types[type].handle || name.empty())
    throw Error(ErrorCode::InvalidInput,
                "'" + name + "' is no constant of type " + model_.types[type].name);
  return handles_.intern(type, name);
}

/// Where an argument is not known there is no value.
ExternalResult QueryEvaluator::call(const Query& q, const std::vector<Index>& slots,
                                    const RuntimeKnowledge& k,
                                    std::vector<Index>* arguments) const {
  std::vector<Index> objects;
  for (const Argument& a : q.arguments) {
    const std::optional<Index> v = value(a, slots, k);
    if (!v) return {};
    objects.push_back(*v);
  }
  if (arguments != nullptr) *arguments = objects;
  if (model_.external_functions[q.symbol].reads_state) return ask(q.symbol, objects, k);
  const auto [it, fresh] = calls_.try_emplace({q.symbol, objects});
  if (fresh) it->second = ask(q.symbol, objects, k);
  return it->second;
}

/// By the call's text, "fetch(robot1, o1, home)".
unsigned QueryEvaluator::choice_of(Index external, const std::vector<Index>& arguments) const {
  std::string text = model_.externals[external].name;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    text += (i == 0 ? "(" : ", ") + model_.name_of(arguments[i], handles_);
  if (!arguments.empty()) text += ")";
  const auto found = choices_.find(text);
  if (found == choices_.end()) return 0;
  chosen_.insert(text);
  return found->second;
}

std::optional<std::string> QueryEvaluator::unused_choice() const {
  for (const auto& [call, choice] : choices_) {
    if (chosen_.contains(call)) continue;
    const std::string name = call.substr(0, call.find('('));
    const auto function = std::ranges::find(model_.externals, name, &Symbol::name);
    // Queries of truth values that are decided without it need not make a call.
    if (function == model_.externals.end() || function->range != kNone) return call;
  }
  return std::nullopt;
}

ExternalResult QueryEvaluator::ask(Index external, const std::vector<Index>& arguments,
                                   const RuntimeKnowledge& k) const {
  ExternalResult result;
  const unsigned choice = choices_.empty() ? 0 : choice_of(external, arguments);
  for (unsigned attempt = 0; attempt < attempts_; ++attempt) {
    KnowledgeReader reader(k, noted_);
    ExternalContext context{reader, handles_, seed_, attempt, choice};
    try {
      result = model_.external_functions[external].call(arguments, context);
    } catch (const LeftOpen&) {
      throw;
    } catch (const std::exception& e) {
      throw Error(ErrorCode::InvalidInput, "external function '" + model_.externals[external].name +
                                               "' failed: " + e.what());
    } catch (...) {
      throw Error(ErrorCode::InvalidInput, "external function '" + model_.externals[external].name +
                                               "' failed: it threw what is no std::exception");
    }
    if (result.kind != Answer::Kind::NotFound) break;
  }
  return result;
}

}  // namespace kaboum::plan
