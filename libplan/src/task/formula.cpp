// Hash-consing of ground formulas, and their simplification.
#include "task/formula.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <unordered_map>

namespace kaboum::plan {
namespace {

constexpr std::size_t kMaximumNodes = 50'000'000;

std::uint64_t mix(std::uint64_t h, std::uint64_t v) {
  h ^= v + 0x9e3779b97f4a7c15ULL + (h << 6U) + (h >> 2U);
  return h * 0xff51afd7ed558ccdULL;
}

}  // namespace

FormulaPool::FormulaPool(const Layout& layout, Limits& limits) : layout_(layout), limits_(limits) {
  nodes_.push_back({Kind::False, false, 0, 0});
  nodes_.push_back({Kind::True, false, 0, 0});
}

Formula FormulaPool::add(Node node, std::vector<Formula> children) {
  const bool connective = !children.empty();
  std::uint64_t h =
      mix(static_cast<std::uint64_t>(node.kind), connective ? children.size() : node.b);
  if (!connective) h = mix(h, node.a);
  for (const Formula c : children) h = mix(h, c);
  const Formula known = index_.find(h, [&](Formula f) {
    const Node& n = nodes_[f];
    if (n.kind != node.kind) return false;
    return connective ? std::equal(begin(f), end(f), children.begin(), children.end())
                      : n.a == node.a && n.b == node.b;
  });
  if (known != kNone) return known;
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
  index_.insert(h, f);
  limits_.work(sizeof(Node) + children.size() * sizeof(Formula) + FlatIndex::kBytesEach);
  return f;
}

Formula FormulaPool::leaf(Kind kind, Index fluent, Index value) {
  return add({kind, false, fluent, value}, {});
}

Formula FormulaPool::negate(Formula f) {
  if (f == kFalse) return kTrue;
  if (f == kTrue) return kFalse;
  const Kind kind = nodes_[f].kind;
  if (kind == Kind::Not) return *begin(f);
  if (!nodes_[f].calls || kind == Kind::External) return add({Kind::Not, false, 0, 0}, {f});
  std::vector<Formula> children(begin(f), end(f));
  for (Formula& c : children) c = negate(c);
  return kind == Kind::And ? any(children) : all(children);
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
  if (std::none_of(kept.begin(), kept.end(), [&](Formula c) { return nodes_[c].calls; }))
    return add({Kind::Xor, false, 0, 0}, std::move(kept));
  std::vector<Formula> only;  // each, and none of the others
  for (std::size_t i = 0; i < kept.size(); ++i) {
    std::vector<Formula> parts;
    for (std::size_t j = 0; j < kept.size(); ++j)
      parts.push_back(j == i ? kept[j] : negate(kept[j]));
    only.push_back(all(parts));
  }
  return any(only);
}

Formula FormulaPool::bits(Index word, Word mask, Word value) {
  if (mask == 0) return kTrue;
  const auto [it, fresh] =
      mask_index_.emplace(std::pair(mask, value), static_cast<Index>(masks_.size()));
  if (fresh) masks_.emplace_back(mask, value);
  return add({Kind::Bits, false, word, it->second}, {});
}

Formula FormulaPool::external(Index call, Index expected) {
  return add({Kind::External, true, call, expected}, {});
}

std::optional<BitTest> FormulaPool::as_bits(Formula f) const {
  const Node& n = nodes_[f];
  switch (n.kind) {
    case Kind::IsTrue:
    case Kind::IsFalse:
    case Kind::ValueIs: {
      const Fluent& fluent = layout_.fluents()[n.a];
      const Word content = n.kind == Kind::IsTrue    ? static_cast<Word>(AtomKnowledge::True)
                           : n.kind == Kind::IsFalse ? static_cast<Word>(AtomKnowledge::False)
                                                     : kFirstValue + n.b;
      return BitTest{fluent.word, fluent.mask, content << fluent.shift};
    }
    case Kind::Bits:
      return BitTest{n.a, masks_[n.b].first, masks_[n.b].second};
    default:
      return std::nullopt;
  }
}

}  // namespace kaboum::plan
