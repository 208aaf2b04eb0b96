#include "task/formula.h"

#include <kaboum/geom/error.h>

#include <algorithm>
#include <chrono>

#include "task/bindings.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumNodes = 50'000'000;

std::uint64_t mix(std::uint64_t h, std::uint64_t v) {
  h ^= v + 0x9e3779b97f4a7c15ULL + (h << 6U) + (h >> 2U);
  return h * 0xff51afd7ed558ccdULL;
}

}  // namespace

FormulaPool::FormulaPool(const Model& model, const Layout& layout, Limits& limits)
    : model_(model), layout_(layout), limits_(limits) {
  nodes_.push_back({Kind::False, false, 0, 0});
  nodes_.push_back({Kind::True, false, 0, 0});
}

Formula FormulaPool::add(Node node, std::vector<Formula> children) {
  const bool connective = !children.empty();
  std::uint64_t h =
      mix(static_cast<std::uint64_t>(node.kind), connective ? children.size() : node.b);
  if (!connective) h = mix(h, node.a);
  for (const Formula c : children) h = mix(h, c);
  const auto [first, last] = index_.equal_range(h);
  for (auto it = first; it != last; ++it) {
    const Node& n = nodes_[it->second];
    if (n.kind != node.kind) continue;
    if (connective
            ? std::equal(begin(it->second), end(it->second), children.begin(), children.end())
            : n.a == node.a && n.b == node.b)
      return it->second;
  }
  if (nodes_.size() >= kMaximumNodes)
    throw Error(ErrorCode::LimitReached, "too many ground formulas");
  const auto f = static_cast<Formula>(nodes_.size());
  node.calls = node.kind == Kind::External;
  if (connective) {
    node.a = static_cast<Index>(children_.size());
    node.b = static_cast<Index>(children.size());
    for (const Formula c : children) node.calls |= nodes_[c].calls;
    children_.insert(children_.end(), children.begin(), children.end());
  }
  nodes_.push_back(node);
  index_.emplace(h, f);
  limits_.work(sizeof(Node) + children.size() * sizeof(Formula) + 48);  // 48: of the index
  return f;
}

Formula FormulaPool::leaf(Kind kind, Index fluent, Index value) {
  return add({kind, false, fluent, value}, {});
}

Formula FormulaPool::negate(Formula f) {
  if (f == kFalse) return kTrue;
  if (f == kTrue) return kFalse;
  if (nodes_[f].kind == Kind::Not) return *begin(f);
  return add({Kind::Not, false, 0, 0}, {f});
}

Formula FormulaPool::join(Kind kind, const std::vector<Formula>& children) {
  const Formula neutral = kind == Kind::And ? kTrue : kFalse;
  const Formula decides = kind == Kind::And ? kFalse : kTrue;
  std::vector<Formula> kept;
  for (const Formula c : children) {
    if (c == neutral) continue;
    if (c == decides) {
      // What stands before it cannot change the result, and nothing in it need be called.
      return decides;
    }
    if (nodes_[c].kind == kind) {
      kept.insert(kept.end(), begin(c), end(c));
    } else {
      kept.push_back(c);
    }
  }
  if (kept.empty()) return neutral;
  // Drop repetitions, keeping the first.
  std::vector<Formula> unique;
  if (kept.size() < 16) {
    for (const Formula c : kept)
      if (std::find(unique.begin(), unique.end(), c) == unique.end()) unique.push_back(c);
  } else {
    std::unordered_map<Formula, bool> seen;
    for (const Formula c : kept)
      if (seen.emplace(c, true).second) unique.push_back(c);
  }
  if (unique.size() == 1) return unique[0];
  return add({kind, false, 0, 0}, std::move(unique));
}

Formula FormulaPool::all(const std::vector<Formula>& children) { return join(Kind::And, children); }
Formula FormulaPool::any(const std::vector<Formula>& children) { return join(Kind::Or, children); }

Formula FormulaPool::one(const std::vector<Formula>& children) {
  std::vector<Formula> kept;
  int certain = 0;
  for (const Formula c : children) {
    if (c == kTrue) ++certain;
    if (c != kTrue && c != kFalse) kept.push_back(c);
  }
  if (certain > 1) return kFalse;
  if (certain == 1) {
    for (Formula& c : kept) c = negate(c);
    return all(kept);
  }
  if (kept.empty()) return kFalse;
  if (kept.size() == 1) return kept[0];
  return add({Kind::Xor, false, 0, 0}, std::move(kept));
}

Formula FormulaPool::bits(Index word, Word mask, Word value) {
  if (mask == 0) return kTrue;
  const auto [it, fresh] =
      mask_index_.emplace(std::pair(mask, value), static_cast<Index>(masks_.size()));
  if (fresh) masks_.emplace_back(mask, value);
  return add({Kind::Bits, false, word, it->second}, {});
}

Formula FormulaPool::external(Index external, std::vector<Index> arguments, Index expected) {
  const auto [it, fresh] =
      call_index_.emplace(std::pair(external, arguments), static_cast<Index>(calls_.size()));
  if (fresh) {
    calls_.push_back({external, std::move(arguments)});
    cached_.push_back(Cached::No);
    results_.emplace_back();
  }
  return add({Kind::External, true, it->second, expected}, {});
}

std::optional<Index> FormulaPool::call(Index call, const Word* state) const {
  const Call& c = calls_[call];
  if (cached_[call] == Cached::Yes) return results_[call];
  const auto run = [&] {
    ++external_calls_;
    const auto start = std::chrono::steady_clock::now();
    const std::optional<Index> result = model_.external_functions[c.external](c.arguments);
    external_seconds_ +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return result;
  };
  if (model_.externals[c.external].is_volatile) {
    const auto [it, fresh] =
        volatile_.try_emplace({call, std::vector<Word>(state, state + layout_.words())});
    if (fresh) {
      limits_.work(sizeof(Word) * layout_.words() + 64);
      it->second = run();
    }
    return it->second;
  }
  results_[call] = run();
  cached_[call] = Cached::Yes;
  return results_[call];
}

bool FormulaPool::calls_volatile(Formula f) const {
  const Node& n = nodes_[f];
  if (!n.calls) return false;
  if (n.kind == Kind::External) return model_.externals[calls_[n.a].external].is_volatile;
  return std::any_of(begin(f), end(f), [&](Formula c) { return calls_volatile(c); });
}

Formula FormulaPool::ground(const Query& q, std::vector<Index>& slots) {
  limits_.work();
  const auto objects = [&] {
    std::vector<Index> out;
    for (const Argument& a : q.arguments) out.push_back(value_of(a, slots.data()));
    return out;
  };
  switch (q.kind) {
    case Query::Kind::True:
      return kTrue;
    case Query::Kind::False:
      return kFalse;
    case Query::Kind::And:
    case Query::Kind::Or:
    case Query::Kind::Xor: {
      std::vector<Formula> children;
      for (const Query& c : q.children) {
        children.push_back(ground(c, slots));
        if (q.kind == Query::Kind::And && children.back() == kFalse) return kFalse;
        if (q.kind == Query::Kind::Or && children.back() == kTrue) return kTrue;
      }
      if (q.kind == Query::Kind::And) return all(children);
      return q.kind == Query::Kind::Or ? any(children) : one(children);
    }
    case Query::Kind::Not:
      return negate(ground(q.children[0], slots));
    case Query::Kind::Exists:
    case Query::Kind::ForAll: {
      const bool exists = q.kind == Query::Kind::Exists;
      std::vector<Formula> children;
      for (const Index o : model_.types[q.type].objects) {
        slots[q.symbol] = o;
        children.push_back(ground(q.children[0], slots));
        if (children.back() == (exists ? kTrue : kFalse)) return children.back();
      }
      return exists ? any(children) : all(children);
    }
    case Query::Kind::Known:
    case Query::Kind::KnowWhether: {
      const Layout::Place p = layout_.atom(q.symbol, objects().data());
      if (!p.exists) return kFalse;
      if (p.fluent == kNone) {
        if (q.kind == Query::Kind::KnowWhether)
          return p.atom != AtomKnowledge::Unknown ? kTrue : kFalse;
        return p.atom == (q.negated ? AtomKnowledge::False : AtomKnowledge::True) ? kTrue : kFalse;
      }
      if (q.kind == Query::Kind::KnowWhether) return leaf(Kind::Whether, p.fluent);
      return leaf(q.negated ? Kind::IsFalse : Kind::IsTrue, p.fluent);
    }
    case Query::Kind::KnownValue:
    case Query::Kind::WhetherValue:
    case Query::Kind::KnowValue: {
      const Layout::Place p = layout_.term(q.symbol, objects().data());
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
      if (q.kind == Query::Kind::KnowValue) return leaf(Kind::ValueKnown, p.fluent);
      if (position == kNone)
        return q.kind == Query::Kind::WhetherValue || q.negated ? kTrue : kFalse;
      if (q.kind == Query::Kind::WhetherValue) return leaf(Kind::ValueWhether, p.fluent, position);
      return leaf(q.negated ? Kind::ValueIsNot : Kind::ValueIs, p.fluent, position);
    }
    case Query::Kind::Same:
      return value_of(q.arguments[0], slots.data()) == value_of(q.arguments[1], slots.data())
                 ? kTrue
                 : kFalse;
    case Query::Kind::External:
      return external(q.symbol, objects(), q.value ? value_of(*q.value, slots.data()) : kNone);
  }
  throw Error(ErrorCode::Internal, "unexpected query");
}

Truth FormulaPool::evaluate(Formula f, const Word* state) const {
  const Node& n = nodes_[f];
  const auto yes = [](bool b) { return b ? Truth::Yes : Truth::No; };
  switch (n.kind) {
    case Kind::False:
      return Truth::No;
    case Kind::True:
      return Truth::Yes;
    case Kind::And:
    case Kind::Or: {
      const Truth decides = n.kind == Kind::And ? Truth::No : Truth::Yes;
      Truth result = n.kind == Kind::And ? Truth::Yes : Truth::No;
      for (const Formula *c = begin(f), *last = end(f); c != last; ++c) {
        if (result == Truth::Open && nodes_[*c].calls) continue;
        const Truth t = evaluate(*c, state);
        if (t == decides) return t;
        if (t == Truth::Open) result = t;
      }
      return result;
    }
    case Kind::Xor: {
      int certain = 0;
      bool open = false;
      for (const Formula *c = begin(f), *last = end(f); c != last; ++c) {
        const Truth t = evaluate(*c, state);
        certain += t == Truth::Yes ? 1 : 0;
        open |= t == Truth::Open;
        if (certain > 1) return Truth::No;
      }
      return open ? Truth::Open : yes(certain == 1);
    }
    case Kind::Not: {
      const Truth t = evaluate(*begin(f), state);
      return t == Truth::Open ? t : yes(t == Truth::No);
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
    case Kind::Bits:
      return yes((state[n.a] & masks_[n.b].first) == masks_[n.b].second);
    case Kind::External: {
      const std::optional<Index> result = call(n.a, state);
      return yes(result && (n.b == kNone || *result == n.b));
    }
  }
  return Truth::No;
}

void FormulaPool::open_fluents(Formula f, const Word* state, std::vector<Index>& out) const {
  const Node& n = nodes_[f];
  switch (n.kind) {
    case Kind::And:
    case Kind::Or:
    case Kind::Xor:
    case Kind::Not:
      if (evaluate(f, state) != Truth::Open) return;
      for (const Formula *c = begin(f), *last = end(f); c != last; ++c) {
        if (nodes_[*c].calls && n.kind != Kind::Not) {
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
    default:
      return;
  }
}

bool FormulaPool::as_bits(Formula f, Index& word, Word& mask, Word& value) const {
  const Node& n = nodes_[f];
  switch (n.kind) {
    case Kind::IsTrue:
    case Kind::IsFalse:
    case Kind::ValueIs: {
      const Fluent& fluent = layout_.fluents()[n.a];
      word = fluent.word;
      mask = fluent.mask;
      const Word content = n.kind == Kind::IsTrue    ? static_cast<Word>(AtomKnowledge::True)
                           : n.kind == Kind::IsFalse ? static_cast<Word>(AtomKnowledge::False)
                                                     : kFirstValue + n.b;
      value = content << fluent.shift;
      return true;
    }
    case Kind::Bits:
      word = n.a;
      mask = masks_[n.b].first;
      value = masks_[n.b].second;
      return true;
    default:
      return false;
  }
}

}  // namespace kaboum::plan
