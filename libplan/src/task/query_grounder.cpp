// Grounding of queries: variables get their objects, and constant knowledge is folded in.
#include "task/query_grounder.h"

#include <kaboum/base/error.h>

#include <utility>

#include "task/bindings.h"

namespace kaboum::plan {

using Kind = FormulaPool::Kind;

namespace {

Formula constant(bool truth) { return truth ? kTrue : kFalse; }

std::vector<Index> objects(const Query& q, const std::vector<Index>& slots) {
  std::vector<Index> out;
  for (const Argument& a : q.arguments) out.push_back(value_of(a, slots.data()));
  return out;
}

}  // namespace

Formula QueryGrounder::ground(const Query& q, std::vector<Index>& slots) {
  limits_.work();
  switch (q.kind) {
    case Query::Kind::True:
      return kTrue;
    case Query::Kind::False:
      return kFalse;
    case Query::Kind::And:
    case Query::Kind::Or:
      return ground_connective(q, slots);
    case Query::Kind::Xor:
    case Query::Kind::Not: {
      const bool outer = std::exchange(monotone_, false);
      const Formula made = q.kind == Query::Kind::Not ? pool_.negate(ground(q.children[0], slots))
                                                      : ground_connective(q, slots);
      monotone_ = outer;
      return made;
    }
    case Query::Kind::Exists:
    case Query::Kind::ForAll:
      return ground_quantifier(q, slots);
    case Query::Kind::Known:
    case Query::Kind::KnowWhether:
      return ground_atom(q, slots);
    case Query::Kind::KnownValue:
    case Query::Kind::WhetherValue:
    case Query::Kind::KnowValue:
      return ground_term(q, slots);
    case Query::Kind::Derived: {
      const Formula f = rules_.atom(q.symbol, objects(q, slots), *this);
      return q.negated ? pool_.negate(f) : f;
    }
    case Query::Kind::Same:
      return constant(value_of(q.arguments[0], slots.data()) ==
                      value_of(q.arguments[1], slots.data()));
    case Query::Kind::External:
    case Query::Kind::Let: {
      const Index call = call_of(q, slots);
      if (q.kind == Query::Kind::Let) slots[q.value->index] = call | kCallOperand;
      // It never holds; but a negation is not to hold either.
      if (monotone_ && calls_.is_never_known(call)) return kFalse;
      return pool_.external(call, q.kind == Query::Kind::External && q.value
                                      ? value_of(*q.value, slots.data())
                                      : kNone);
    }
  }
  throw Error(ErrorCode::Internal, "unexpected query");
}

Index QueryGrounder::operand(const Argument& a, const std::vector<Index>& slots) const {
  if (!a.term) return value_of(a, slots.data());
  std::vector<Index> arguments;
  for (const Argument& x : a.term->arguments) arguments.push_back(value_of(x, slots.data()));
  const Layout::Field at = layout_.term(a.term->function, arguments.data());
  if (!at.exists) return kNone;
  return at.fluent == kNone ? at.value : at.fluent | kTermOperand;
}

Index QueryGrounder::call_of(const Query& q, const std::vector<Index>& slots) {
  std::vector<Index> operands;
  for (const Argument& a : q.arguments) operands.push_back(operand(a, slots));
  return calls_.call(q.symbol, std::move(operands));
}

Formula QueryGrounder::ground_connective(const Query& q, std::vector<Index>& slots) {
  std::vector<Formula> children;
  for (const Query& c : q.children) {
    children.push_back(ground(c, slots));
    if (q.kind == Query::Kind::And && children.back() == kFalse) return kFalse;
    if (q.kind == Query::Kind::Or && children.back() == kTrue) return kTrue;
  }
  if (q.kind == Query::Kind::And) return pool_.all(children);
  return q.kind == Query::Kind::Or ? pool_.any(children) : pool_.one(children);
}

Formula QueryGrounder::ground_quantifier(const Query& q, std::vector<Index>& slots) {
  const bool exists = q.kind == Query::Kind::Exists;
  std::vector<Formula> children;
  for (const Index o : model_.types[q.type].objects) {
    slots[q.symbol] = o;
    children.push_back(ground(q.children[0], slots));
    if (children.back() == constant(exists)) return children.back();
  }
  return exists ? pool_.any(children) : pool_.all(children);
}

Formula QueryGrounder::ground_atom(const Query& q, const std::vector<Index>& slots) {
  const Layout::Field p = layout_.atom(q.symbol, objects(q, slots).data());
  if (!p.exists) return kFalse;
  if (p.fluent == kNone) {
    if (q.kind == Query::Kind::KnowWhether)
      return p.atom != AtomKnowledge::Unknown ? kTrue : kFalse;
    return p.atom == (q.negated ? AtomKnowledge::False : AtomKnowledge::True) ? kTrue : kFalse;
  }
  if (q.kind == Query::Kind::KnowWhether) return pool_.leaf(Kind::Whether, p.fluent);
  return pool_.leaf(q.negated ? Kind::IsFalse : Kind::IsTrue, p.fluent);
}

Formula QueryGrounder::ground_term(const Query& q, const std::vector<Index>& slots) {
  const Layout::Field p = layout_.term(q.symbol, objects(q, slots).data());
  if (!p.exists) return kFalse;
  Index position = kNone;
  Index value = kNone;
  if (q.value) {
    value = value_of(*q.value, slots.data());
    position = layout_.position(model_.functions[q.symbol].range, value);
  }
  if (p.fluent == kNone) {
    // A value outside the range is never the value.
    if (p.value == kNone)
      return q.value && position == kNone && (q.kind == Query::Kind::WhetherValue || q.negated)
                 ? kTrue
                 : kFalse;
    if (q.kind != Query::Kind::KnownValue) return kTrue;
    return (p.value == value) != q.negated ? kTrue : kFalse;
  }
  if (q.kind == Query::Kind::KnowValue) return pool_.leaf(Kind::ValueKnown, p.fluent);
  if (position == kNone) return q.kind == Query::Kind::WhetherValue || q.negated ? kTrue : kFalse;
  if (q.kind == Query::Kind::WhetherValue)
    return pool_.leaf(Kind::ValueWhether, p.fluent, position);
  return pool_.leaf(q.negated ? Kind::ValueIsNot : Kind::ValueIs, p.fluent, position);
}

}  // namespace kaboum::plan
