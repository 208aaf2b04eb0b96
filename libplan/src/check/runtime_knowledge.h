#pragma once

#include <kaboum/plan/model.h>

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::plan {

/// A ground atom or term: 0 or 1 (a function), symbol, arguments.
using Fact = std::vector<Index>;
/// An atom, and whether it is the atom or its negation that holds.
using FactLiteral = std::pair<Fact, bool>;

/// Stops whatever looks at, or changes, what was sensed but left open
/// (RuntimeKnowledge::leave_open): it has to be done for each outcome by itself.
struct LeftOpen {
  Fact fact;
};

/// What an agent knows at run time, when every sensed value is at hand: plain sets, no packing. The
/// validator's, and only its, notion of a state; the rules are those of
/// docs/planning/knowledge-states.md, written a second time.
class RuntimeKnowledge {
 public:
  [[nodiscard]] bool operator<(const RuntimeKnowledge& other) const;

  [[nodiscard]] bool knows(const Fact& atom, bool truth) const;
  [[nodiscard]] bool knows_whether(const Fact& atom) const {
    return atoms_.contains(atom) || open_.contains(atom);
  }
  [[nodiscard]] const Index* value(const Fact& term) const;
  [[nodiscard]] bool rules_out(const Fact& term, Index value) const;

  /// It is sensed, and stands for all its outcomes until one is looked at. All else that is asked
  /// or done of it throws LeftOpen. @pre it is not known, and no disjunction says anything of it.
  void leave_open(const Fact& f) { open_.insert(f); }
  [[nodiscard]] bool is_open(const Fact& f) const { return open_.contains(f); }
  /// It is as it was before it was sensed.
  void look_at(const Fact& f) { open_.erase(f); }

  // The world as it is: outcomes of sensing and initial facts. False: contradiction.
  bool learn(const Fact& atom, bool truth);
  bool learn_value(const Fact& term, Index value, const std::vector<Index>& range);
  bool learn_not_value(const Fact& term, Index value, const std::vector<Index>& range);
  bool learn_exclusive(const std::set<Fact>& atoms);
  bool learn_some(std::set<FactLiteral> literals);

  // Changes of the world.
  void become(const Fact& atom, bool truth);
  void forget(const Fact& atom);
  void become_value(const Fact& term, Index value);
  void forget_value(const Fact& term);
  void drop_exclusive(const std::set<Fact>& atoms);

  // All there is; of a disjunction the atoms that are not decided.
  [[nodiscard]] const std::map<Fact, bool>& atoms() const { return atoms_; }
  [[nodiscard]] const std::map<Fact, Index>& values() const { return values_; }
  [[nodiscard]] const std::map<Fact, std::set<Index>>& excluded() const { return excluded_; }
  [[nodiscard]] const std::map<std::set<Fact>, std::set<Fact>>& exclusive() const {
    return exclusive_;
  }
  /// At least one literal of each holds.
  [[nodiscard]] const std::set<std::set<FactLiteral>>& some() const { return some_; }
  /// Atoms that are not decided, and of which disjunctions say something.
  [[nodiscard]] std::set<Fact> tied() const;
  /// Whether less is kept than is known: a disjunction went whose atoms said something of each
  /// other still, or something happened that hangs on what is unknown.
  [[nodiscard]] bool cut() const { return cut_; }
  void keep_less() { cut_ = true; }

  /// Only what follows from this and from the other alike, in both from these entries of Kx.
  void weaken_to(const RuntimeKnowledge& other, const std::set<std::set<Fact>>& entries);
  /// Only what is in `live`, and what Kx ties to it.
  void restrict_to(const std::set<Fact>& live);

 private:
  [[nodiscard]] std::set<Fact> candidates(const std::set<Fact>& entry) const;
  [[nodiscard]] bool exactly_one(const std::set<Fact>& atoms) const;
  bool propagate();
  bool conclude_exclusive(bool& again);
  bool conclude_some(bool& again);
  void release(const Fact& atom);
  void require_seen(const Fact& f) const {
    if (!open_.empty() && open_.contains(f)) throw LeftOpen{f};
  }

  std::map<Fact, bool> atoms_;
  std::map<Fact, Index> values_;
  std::map<Fact, std::set<Index>> excluded_;
  /// Each with the entry it came from: del(Kx) names that.
  std::map<std::set<Fact>, std::set<Fact>> exclusive_;
  std::set<std::set<FactLiteral>> some_;
  std::set<Fact> open_;  ///< sensed, and not looked at
  bool cut_ = false;
};

}  // namespace kaboum::plan
