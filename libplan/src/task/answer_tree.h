#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::plan {

/// An argument of an external function, once ground: an object; or, evaluated in each state, the
/// value of a fluent or of another call; or kNone: the value of a term that is never known. Objects
/// and handles have numbers below these bits.
inline constexpr Index kTermOperand = Index{1} << 30U;  ///< or'ed with a fluent
inline constexpr Index kCallOperand = Index{1} << 31U;  ///< or'ed with a call
inline bool is_call(Index operand) { return operand != kNone && (operand & kCallOperand) != 0; }
inline bool is_term(Index operand) {
  return (operand & kCallOperand) == 0 && (operand & kTermOperand) != 0;
}

/// What a call of an external function read, in order: fluents and their contents, or calls (as
/// operands) and their values. Its footprint.
using Footprint = std::vector<std::pair<Index, Index>>;

/// Answers of external functions by footprint.
///
/// A function that is asked again about a state that agrees on what it read must read the same, so
/// the answers to a call are the leaves of a tree: each inner node is what is read next (a fluent,
/// or an argument's value), each edge a content. All edges are in one flat table.
class AnswerTree {
 public:
  struct Leaf {
    Index value = 0;
    Index text = kNone;          ///< payload or reason
    std::uint16_t attempts = 0;  ///< made so far
    Answer::Kind kind = Answer::Kind::Impossible;
    [[nodiscard]] bool operator==(const Leaf&) const = default;
  };
  /// The tree of one call.
  struct Root {
    Index node = kNone;  ///< or a leaf
    Index last = kNone;  ///< the leaf that it was given last
  };

  static bool is_leaf(Index node) { return node != kNone && (node & kLeaf) != 0; }
  static Index leaf_number(Index node) { return node & ~kLeaf; }

  [[nodiscard]] Leaf leaf(Index number) const {
    return is_plain(number) ? Leaf{number & ~kPlain, kNone, 1, Answer::Kind::Value}
                            : leaves_[number];
  }
  /// What an inner node reads.
  [[nodiscard]] Index reads(Index node) const { return nodes_[node]; }
  /// Where that content leads; kNone: nowhere yet.
  [[nodiscard]] Index child(Index node, Index content) const;

  struct Inserted {
    Index leaf = kNone;
    bool fresh = false;  ///< it was not there before
  };
  /// Puts the answer where what was read leads. Answers that say the same are one, unless they may
  /// be replaced. nullopt: other things were read than before.
  /// @throws Error{LimitReached}
  std::optional<Inserted> insert(Root& root, const Footprint& read, Leaf leaf);

  /// The number of a text; kNone: it is empty.
  Index text(std::string text);
  [[nodiscard]] const std::string& payload(Index leaf) const;

  [[nodiscard]] std::size_t bytes() const {
    return nodes_.capacity() * sizeof(Index) + edges_.size() * sizeof(Edge) +
           leaves_.capacity() * sizeof(Leaf);
  }

 private:
  static constexpr Index kLeaf = Index{1} << 31U;
  /// Of a leaf's number: all that there is to it is the value, in the other bits.
  static constexpr Index kPlain = Index{1} << 30U;
  static bool is_plain(Index leaf) { return leaf != kNone && (leaf & kPlain) != 0; }
  struct Edge {
    Index node = kNone;
    Index content = 0;
    Index child = 0;
  };

  void link(Root& root, Index parent, Index content, Index child);
  [[nodiscard]] std::size_t slot(Index node, Index content) const;

  std::vector<Index> nodes_;                         ///< what each reads
  std::vector<Edge> edges_ = std::vector<Edge>(64);  ///< open addressing
  std::size_t edge_count_ = 0;
  std::vector<Leaf> leaves_;
  std::vector<std::string> texts_;
};

}  // namespace kaboum::plan
