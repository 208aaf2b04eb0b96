#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "task/flat_index.h"
#include "task/layout.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// A ground formula; equal formulas of one pool have equal numbers.
using Formula = std::uint32_t;
inline constexpr Formula kFalse = 0;
inline constexpr Formula kTrue = 1;

/// (state[word] & mask) == value: most conditions of actions are one. With mask 0 it is none.
struct BitTest {
  Index word = 0;
  Word mask = 0;
  Word value = 0;
  [[nodiscard]] bool holds(const Word* state) const { return (state[word] & mask) == value; }
};

/// Ground formulas over the fields of a layout, each kept once, simplified as they are made.
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
    External,      ///< call a, expected value b (kNone: true)
    Derived        ///< derived atom a (derived_atoms.h)
  };
  struct Node {
    Kind kind = Kind::False;
    bool calls = false;  ///< an External is in it
    Index a = 0;  ///< fluent, word, call or derived atom; of a connective: first child in children_
    Index b = 0;  ///< value; of a connective: number of children
  };

  FormulaPool(const Layout& layout, Limits& limits);

  Formula leaf(Kind kind, Index fluent, Index value = 0);
  /// What makes calls is negated down to the calls: a formula that is not Yes may say nothing,
  /// where an argument is not known.
  Formula negate(Formula f);
  Formula all(const std::vector<Formula>& children);  ///< conjunction, in order; flattened
  Formula any(const std::vector<Formula>& children);  ///< disjunction
  Formula one(const std::vector<Formula>& children);  ///< exclusive or: exactly one
  Formula bits(Index word, Word mask, Word value);
  Formula external(Index call, Index expected);
  Formula derived(Index atom) { return leaf(Kind::Derived, atom); }

  [[nodiscard]] const Node& node(Formula f) const { return nodes_[f]; }
  [[nodiscard]] const Formula* begin(Formula f) const { return children_.data() + nodes_[f].a; }
  [[nodiscard]] const Formula* end(Formula f) const { return begin(f) + nodes_[f].b; }
  [[nodiscard]] Word bits_mask(const Node& n) const { return masks_[n.b].first; }
  [[nodiscard]] Word bits_value(const Node& n) const { return masks_[n.b].second; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  /// If `f` is "this field has this content".
  [[nodiscard]] std::optional<BitTest> as_bits(Formula f) const;

 private:
  Formula add(Node node, std::vector<Formula> children);
  Formula join(Kind kind, const std::vector<Formula>& children);

  const Layout& layout_;
  Limits& limits_;
  std::vector<Node> nodes_;
  std::vector<Formula> children_;
  std::vector<std::pair<Word, Word>> masks_;
  FlatIndex index_;
  std::map<std::pair<Word, Word>, Index> mask_index_;
};

}  // namespace kaboum::plan
