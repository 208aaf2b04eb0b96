// Queries evaluated on the lifted model, one object after another.
#include "check/query_evaluator.h"

#include <kaboum/base/error.h>

#include <algorithm>

namespace kaboum::plan {

Fact fact(bool function, Index symbol, const std::vector<Argument>& arguments,
          const std::vector<Index>& slots) {
  Fact f = {function ? Index{1} : Index{0}, symbol};
  for (const Argument& a : arguments) f.push_back(a.variable ? slots.at(a.index) : a.index);
  return f;
}

bool QueryEvaluator::holds(const Query& q, std::vector<Index>& slots,
                           const RuntimeKnowledge& k) const {
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
    case Query::Kind::WhetherValue:
      return holds_of_value(q, slots, k);
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

void QueryEvaluator::reads(const Query& q, std::vector<Index>& slots, std::set<Fact>& out) const {
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

std::optional<Index> QueryEvaluator::call(Index external, std::vector<Index> arguments) const {
  const auto [it, fresh] = calls_.try_emplace({external, std::move(arguments)});
  if (fresh) it->second = model_.external_functions[external](it->first.second);
  return it->second;
}

}  // namespace kaboum::plan
