#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "task/external_calls.h"
#include "task/layout.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// A ground formula; equal formulas of one pool have equal numbers.
using Formula = std::uint32_t;
inline constexpr Formula kFalse = 0;
inline constexpr Formula kTrue = 1;

/// What a plan-time state says of a query: it stands for every way its sensed values may turn out.
/// Open: the query holds for some of them and fails for others.
/// Unresolved: an external function that it calls found nothing so far.
enum class Truth : std::uint8_t { No, Yes, Open, Unresolved };

/// (state[word] & mask) == value: most conditions of actions are one. With mask 0 it is none.
struct BitTest {
  Index word = 0;
  Word mask = 0;
  Word value = 0;
  [[nodiscard]] bool holds(const Word* state) const { return (state[word] & mask) == value; }
};

/// Hash-consed ground formulas over the fields of a layout.
class FormulaPool {
 public:
  enum class Kind : std::uint8_t {
    False,
    True,
    And,
    Or,
    Xor,
    Not,
    IsTrue,        ///< K(p)
    IsFalse,       ///< K(!p)
    Whether,       ///< Kw(p)
    ValueIs,       ///< K(f = v), v a position in the range
    ValueIsNot,    ///< K(f != v)
    ValueWhether,  ///< Kw(f = v)
    ValueKnown,    ///< Kv(f)
    Bits,          ///< state[a] & masks_[b] == values_[b]
    External       ///< call a, expected value b (kNone: true)
  };
  struct Node {
    Kind kind = Kind::False;
    bool calls = false;  ///< an External is in it
    Index a = 0;         ///< fluent, word or call; of a connective: first child in children_
    Index b = 0;         ///< value; of a connective: number of children
  };

  FormulaPool(const Model& model, const Layout& layout, Limits& limits);

  Formula leaf(Kind kind, Index fluent, Index value = 0);
  /// What makes calls is negated down to the calls: a formula that is not Yes may say nothing,
  /// where an argument is not known.
  Formula negate(Formula f);
  Formula all(const std::vector<Formula>& children);  ///< conjunction, in order; flattened
  Formula any(const std::vector<Formula>& children);  ///< disjunction
  Formula one(const std::vector<Formula>& children);  ///< exclusive or: exactly one
  Formula bits(Index word, Word mask, Word value);
  Formula external(Index call, Index expected);

  /// The query for these slots. Constant knowledge is folded in.
  Formula ground(const Query& query, std::vector<Index>& slots);

  /// Conjunctions and disjunctions are evaluated from left to right and stop at the first child
  /// that decides; an External is not called once an earlier child is open.
  [[nodiscard]] Truth evaluate(Formula f, const Word* state) const;
  [[nodiscard]] bool holds(Formula f, const Word* state) const {
    return evaluate(f, state) == Truth::Yes;
  }
  /// Fluents whose sensed value leaves `f` open in `state`.
  void open_fluents(Formula f, const Word* state, std::vector<Index>& out) const;

  [[nodiscard]] const Node& node(Formula f) const { return nodes_[f]; }
  [[nodiscard]] const Formula* begin(Formula f) const { return children_.data() + nodes_[f].a; }
  [[nodiscard]] const Formula* end(Formula f) const { return begin(f) + nodes_[f].b; }
  [[nodiscard]] Word bits_mask(const Node& n) const { return masks_[n.b].first; }
  [[nodiscard]] Word bits_value(const Node& n) const { return masks_[n.b].second; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  /// If `f` is "this field has this content".
  [[nodiscard]] std::optional<BitTest> as_bits(Formula f) const;

  [[nodiscard]] ExternalCalls& calls() const { return calls_; }
  /// Whether a call is in it whose answer can differ between states.
  [[nodiscard]] bool depends_on_calls(Formula f) const;
  /// The call that a query `let ?y = extern(...)` makes, for these slots; kNone: it has no value.
  Index call_of(const Query& q, const std::vector<Index>& slots);
  /// What an argument stands for: an object, or an operand (external_calls.h); kNone: nothing.
  [[nodiscard]] Index operand(const Argument& a, const std::vector<Index>& slots) const;

 private:
  /// Whether the External `f` is not called in `state`, for want of a known argument.
  [[nodiscard]] bool lacks_argument(Formula f, const Word* state) const;
  Formula add(Node node, std::vector<Formula> children);
  Formula join(Kind kind, const std::vector<Formula>& children);
  Formula ground_connective(const Query& q, std::vector<Index>& slots);
  Formula ground_quantifier(const Query& q, std::vector<Index>& slots);
  Formula ground_atom(const Query& q, const std::vector<Index>& slots);
  Formula ground_term(const Query& q, const std::vector<Index>& slots);
  /// Undecided now, but a sensed atom of the same exclusive-or entries may decide it.
  [[nodiscard]] bool tied(Index fluent, AtomKnowledge k, const Word* state) const {
    return k == AtomKnowledge::Unknown && !layout_.fluents()[fluent].groups.empty() &&
           layout_.sensed_tie(fluent, state) != kNone;
  }
  [[nodiscard]] bool excluded(const Fluent& f, const Word* state, Index value) const {
    return f.exclusions != kNone && ((state[f.exclusions + value / 64] >> (value % 64)) & 1U) != 0;
  }

  const Model& model_;
  const Layout& layout_;
  Limits& limits_;
  std::vector<Node> nodes_;
  std::vector<Formula> children_;
  std::vector<std::pair<Word, Word>> masks_;
  std::unordered_multimap<std::uint64_t, Formula> index_;
  std::map<std::pair<Word, Word>, Index> mask_index_;
  mutable ExternalCalls calls_;
  bool monotone_ = true;  ///< ground() is within no negation and no exclusive or
};

}  // namespace kaboum::plan
