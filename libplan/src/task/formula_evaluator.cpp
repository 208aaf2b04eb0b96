// What a state says of a formula, and which sensed values leave it open.
#include "task/formula_evaluator.h"

#include <algorithm>

namespace kaboum::plan {

using Kind = FormulaPool::Kind;

namespace {

/// A conjunction or disjunction.
Truth joined(const FormulaEvaluator& in, const FormulaPool& pool, Formula f, const Word* state) {
  // From what decides least to what decides most; And: Yes, Open, Unresolved, No.
  const bool all = pool.node(f).kind == Kind::And;
  const Truth decides = all ? Truth::No : Truth::Yes;
  Truth result = all ? Truth::Yes : Truth::No;
  for (const Formula *c = pool.begin(f), *last = pool.end(f); c != last; ++c) {
    if ((result == Truth::Open || (all && result == Truth::Unresolved)) && pool.node(*c).calls)
      continue;
    const Truth t = in.evaluate(*c, state);
    if (t == decides) return t;
    if (t == (all ? Truth::Unresolved : Truth::Open) ||
        (t != result && result == (all ? Truth::Yes : Truth::No)))
      result = t;
  }
  return result;
}

/// Exactly one of the children, which make no calls.
Truth exclusive(const FormulaEvaluator& in, const FormulaPool& pool, Formula f, const Word* state) {
  int certain = 0;
  bool open = false;
  for (const Formula *c = pool.begin(f), *last = pool.end(f); c != last; ++c) {
    const Truth t = in.evaluate(*c, state);
    certain += t == Truth::Yes ? 1 : 0;
    open |= t == Truth::Open;
    if (certain > 1) return Truth::No;
  }
  if (open) return Truth::Open;
  return certain == 1 ? Truth::Yes : Truth::No;
}

}  // namespace

Truth FormulaEvaluator::evaluate(Formula f, const Word* state) const {
  const FormulaPool::Node& n = pool_.node(f);
  const auto yes = [](bool b) { return b ? Truth::Yes : Truth::No; };
  switch (n.kind) {
    case Kind::False:
      return Truth::No;
    case Kind::True:
      return Truth::Yes;
    case Kind::And:
    case Kind::Or:
      return joined(*this, pool_, f, state);
    case Kind::Xor:
      return exclusive(*this, pool_, f, state);
    case Kind::Not: {
      const Truth t = evaluate(*pool_.begin(f), state);
      if (t == Truth::Open || t == Truth::Unresolved) return t;
      return yes(t == Truth::No && !(n.calls && lacks_argument(*pool_.begin(f), state)));
    }
    case Kind::IsTrue:
    case Kind::IsFalse: {
      const auto k = static_cast<AtomKnowledge>(layout_.fluents()[n.a].get(state));
      if (k == AtomKnowledge::Whether || tied(n.a, k, state)) return Truth::Open;
      return yes(k == (n.kind == Kind::IsTrue ? AtomKnowledge::True : AtomKnowledge::False));
    }
    case Kind::Whether: {
      const auto k = static_cast<AtomKnowledge>(layout_.fluents()[n.a].get(state));
      return tied(n.a, k, state) ? Truth::Open : yes(k != AtomKnowledge::Unknown);
    }
    case Kind::ValueKnown:
      return yes(layout_.fluents()[n.a].get(state) != kValueUnknown);
    case Kind::ValueIs: {
      const Fluent& fluent = layout_.fluents()[n.a];
      const Word v = fluent.get(state);
      if (v >= kFirstValue) return yes(v == kFirstValue + n.b);
      if (v == kValueUnknown || excluded(fluent, state, n.b)) return Truth::No;
      return Truth::Open;
    }
    case Kind::ValueIsNot: {
      const Fluent& fluent = layout_.fluents()[n.a];
      const Word v = fluent.get(state);
      if (v >= kFirstValue) return yes(v != kFirstValue + n.b);
      if (excluded(fluent, state, n.b)) return Truth::Yes;
      return v == kValueSensed ? Truth::Open : Truth::No;
    }
    case Kind::ValueWhether: {
      const Fluent& fluent = layout_.fluents()[n.a];
      return yes(fluent.get(state) != kValueUnknown || excluded(fluent, state, n.b));
    }
    case Kind::Derived:
      return yes(derived_.holds(n.a, state, *this));
    case Kind::Bits:
      return yes((state[n.a] & pool_.bits_mask(n)) == pool_.bits_value(n));
    case Kind::External: {
      const ExternalCalls::Reply reply = calls_.evaluate(n.a, state);
      using R = ExternalCalls::Reply::Kind;
      if (reply.kind == R::Open) return Truth::Open;
      if (reply.kind == R::NotFound) return Truth::Unresolved;
      return yes(reply.kind == R::Value && (n.b == kNone || reply.value == n.b));
    }
  }
  return Truth::No;
}

bool FormulaEvaluator::lacks_argument(Formula f, const Word* state) const {
  return calls_.evaluate(pool_.node(f).a, state).unknown_argument;
}

void FormulaEvaluator::open_fluents(Formula f, const Word* state, std::vector<Index>& out) const {
  const FormulaPool::Node& n = pool_.node(f);
  switch (n.kind) {
    case Kind::And:
    case Kind::Or:
    case Kind::Xor:
    case Kind::Not:
      if (evaluate(f, state) != Truth::Open) return;
      for (const Formula *c = pool_.begin(f), *last = pool_.end(f); c != last; ++c) {
        if (pool_.node(*c).calls && n.kind != Kind::Not) {
          // Called only when all before it is decided: what is open before it comes first.
          if (!out.empty()) continue;
        }
        open_fluents(*c, state, out);
      }
      return;
    case Kind::IsTrue:
    case Kind::IsFalse:
    case Kind::Whether:
    case Kind::ValueIs:
    case Kind::ValueIsNot: {
      if (evaluate(f, state) != Truth::Open) return;
      const Fluent& fluent = layout_.fluents()[n.a];
      const bool undecided =
          !fluent.function && fluent.get(state) == static_cast<Word>(AtomKnowledge::Unknown);
      const Index needed = undecided ? layout_.sensed_tie(n.a, state) : n.a;
      if (std::find(out.begin(), out.end(), needed) == out.end()) out.push_back(needed);
      return;
    }
    case Kind::External: {
      const ExternalCalls::Reply reply = calls_.evaluate(n.a, state);
      if (reply.kind == ExternalCalls::Reply::Kind::Open &&
          std::find(out.begin(), out.end(), reply.fluent) == out.end())
        out.push_back(reply.fluent);
      return;
    }
    default:
      return;
  }
}

bool FormulaEvaluator::depends_on_calls(Formula f) const {
  const FormulaPool::Node& n = pool_.node(f);
  if (!n.calls) return false;
  if (n.kind == Kind::External) return calls_.depends_on_state(n.a);
  return std::any_of(pool_.begin(f), pool_.end(f), [&](Formula c) { return depends_on_calls(c); });
}

}  // namespace kaboum::plan
