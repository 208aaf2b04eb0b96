#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <map>
#include <vector>

#include "task/atom_knowledge.h"
#include "task/change_analysis.h"
#include "task/numbering.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

using Word = std::uint64_t;

/// Knowledge of one function term, as stored: an index. Larger values are kFirstValue + the
/// position of the known value in the range type.
inline constexpr Word kValueUnknown = 0;
inline constexpr Word kValueSensed = 1;  ///< in Kv
inline constexpr Word kFirstValue = 2;
inline constexpr unsigned kHandleBits = 32;  ///< of a term whose value is a handle

/// A ground atom or function term that actions, sensing or disjunctive knowledge can change: a
/// field of the state. Fields never straddle words.
struct Fluent {
  bool function = false;
  Index symbol = 0;
  std::vector<Index> arguments;
  Index word = 0;
  unsigned shift = 0;
  Word mask = 0;             ///< in place
  Index range = kNone;       ///< of a function
  bool handle = false;       ///< its values are handles
  Index exclusions = kNone;  ///< first word of the bit set of excluded values, if one is kept
  Index exclusion_words = 0;
  std::vector<std::pair<Index, Index>> groups;  ///< Kx groups it is in, and its bit there

  [[nodiscard]] Word get(const Word* state) const { return (state[word] & mask) >> shift; }
};

/// An exclusive-or entry of Kx: exactly one of the members whose bit is set holds.
struct Group {
  std::vector<Index> members;  ///< fluents
  Index word = 0;              ///< the first of its words, 64 members each

  [[nodiscard]] Index words() const { return static_cast<Index>((members.size() + 63) / 64); }
  [[nodiscard]] bool contains(const Word* state, Index member) const {
    return ((state[word + member / 64] >> (member % 64)) & 1U) != 0;
  }
};

/// Where each piece of knowledge is in a state. Atoms and terms that nothing can change have no
/// field; what is known of them is constant. So a state of STACKED 8 is one 64-bit word.
class Layout {
 public:
  Layout(const Model& model, Limits& limits);

  struct Field {
    Index fluent = kNone;                         ///< kNone: constant
    AtomKnowledge atom = AtomKnowledge::Unknown;  ///< constant knowledge of an atom
    Index value = kNone;                          ///< constant value of a term; kNone: unknown
    bool exists = true;                           ///< false: an argument is not of its type
  };
  [[nodiscard]] Field atom(Index predicate, const Index* arguments) const;
  [[nodiscard]] Field term(Index function, const Index* arguments) const;

  /// Calls `visit(arguments)` for the atoms of a predicate that are true for good.
  template <class Visit>
  void true_constants(Index predicate, const Visit& visit) const {
    for (std::size_t n = numbering_.first_atom()[predicate];
         n < numbering_.first_atom()[predicate + 1]; ++n)
      if (atom_fluents_[n] == kNone && atom_constants_[n] == AtomKnowledge::True)
        visit(numbering_.arguments(predicate, n));
  }

  /// Position of an object among those of a type; kNone if it is not one of them. Handles are
  /// their own positions.
  [[nodiscard]] Index position(Index type, Index object) const {
    const Index p = numbering_.position(type, object);
    return p != kNone && model_.types[type].handle ? object : p;
  }
  /// The object, or handle, at this position in the range of a function's fluent.
  [[nodiscard]] Index object(Index fluent, Index position) const {
    const Type& range = model_.types[fluents_[fluent].range];
    return range.handle ? position : range.objects[position];
  }

  [[nodiscard]] const std::vector<Fluent>& fluents() const { return fluents_; }
  [[nodiscard]] const std::vector<Group>& groups() const { return groups_; }
  /// The group with these members (any order); kNone if there is none.
  [[nodiscard]] Index group(std::vector<Index> members) const;
  [[nodiscard]] Index words() const { return words_; }
  [[nodiscard]] std::size_t range_size(const Fluent& f) const {
    return model_.types[f.range].objects.size();
  }
  /// For an undecided atom in exclusive-or entries: a sensed atom whose value, once known, may
  /// decide it. kNone: there is none, and the atom will stay undecided.
  [[nodiscard]] Index sensed_tie(Index fluent, const Word* state) const;
  /// Whether sensing can happen at all, so that queries may be open.
  [[nodiscard]] bool sensing() const { return sensing_; }

 private:
  struct BitAllocator;

  void make_fluents(const std::vector<Symbol>& symbols, bool function,
                    const std::vector<char>& changes, std::vector<Index>& fluent_of);
  void make_groups(const std::vector<std::vector<ChangeAnalysis::Atom>>& entries);
  void assign_words(const std::vector<char>& function_exclusions);

  const Model& model_;
  Numbering numbering_;
  std::vector<Index> atom_fluents_, term_fluents_;  ///< by number; kNone: constant
  std::vector<AtomKnowledge> atom_constants_;
  std::vector<Index> term_constants_;
  std::vector<Fluent> fluents_;
  std::vector<Group> groups_;
  std::map<std::vector<Index>, Index> group_by_members_;
  Index words_ = 0;
  bool sensing_ = false;
};

}  // namespace kaboum::plan
