#pragma once

#include <kaboum/plan/model.h>
#include <kaboum/plan/plan.h>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "check/runtime_knowledge.h"

namespace kaboum::plan {

class DerivedFacts;

/// The atom or term for these slots.
Fact fact(bool function, Index symbol, const std::vector<Argument>& arguments,
          const std::vector<Index>& slots);

/// The object that an argument, no term, stands for.
inline Index object(const Argument& a, const std::vector<Index>& slots) {
  return a.variable ? slots.at(a.index) : a.index;
}

/// Evaluates queries of the lifted model, or lists what they read. `let` gives its slot a value.
class QueryEvaluator {
 public:
  /// @param plan  says the seed, and how often calls that find nothing are made again.
  QueryEvaluator(const Model& model, const Plan& plan);

  /// nullopt: it rests on an external function that finds nothing.
  std::optional<bool> truth(const Query& q, std::vector<Index>& slots,
                            const RuntimeKnowledge& k) const;
  /// Whether `!q` holds. A call with an argument that is not known neither holds nor is denied.
  std::optional<bool> denied(const Query& q, std::vector<Index>& slots,
                             const RuntimeKnowledge& k) const;
  bool holds(const Query& q, std::vector<Index>& slots, const RuntimeKnowledge& k) const {
    return truth(q, slots, k).value_or(false);
  }

  /// In which of the worlds that what is known allows a condition holds.
  enum class Extent : std::uint8_t { NoWorld, SomeWorlds, EveryWorld };
  /// Whose condition it is: of the world, where K(p) stands for p and all is known; or of the
  /// agent, where only K(p) and K(f = c) do, and what asks for knowledge is about the agent's.
  enum class Subject : std::uint8_t { World, Agent };
  /// By Kleene's strong three-valued logic: never wrong, but where atoms of a condition hang on one
  /// another it may say SomeWorlds where more could be said.
  [[nodiscard]] Extent extent(const Query& q, Subject of, std::vector<Index>& slots,
                              const RuntimeKnowledge& k) const;

  /// Adds what the query reads, but for what external functions ask of the state: that is noted.
  /// @return false if it may read anything, by rules.
  bool reads(const Query& q, std::vector<Index>& slots, std::set<Fact>& out) const;

  /// From now on facts that external functions ask of the state are added to `reads`.
  /// @param reads  outlives it, or is replaced; nullptr: nothing is noted.
  void note_reads(std::set<Fact>* reads) const { noted_ = reads; }

  /// The object or handle that an argument stands for; nullopt: a term whose value is not known.
  std::optional<Index> value(const Argument& a, const std::vector<Index>& slots,
                             const RuntimeKnowledge& k) const;

  /// A stated choice of a function that returns values whose call was not made so far, by its text;
  /// nullopt: there is none.
  [[nodiscard]] std::optional<std::string> unused_choice() const;

  /// What the `let`s of a precondition, among its conjuncts, say in this state.
  std::vector<Plan::Call> calls(const Query& precondition, std::vector<Index>& slots,
                                const RuntimeKnowledge& k) const;

  /// The object, or the handle, of a type and name.
  /// @throws Error{InvalidInput} where there is none.
  [[nodiscard]] Index named(Index type, const std::string& name) const;
  /// The name of an object, or the word of a handle.
  [[nodiscard]] std::string name(Index object) const { return model_.name_of(object, handles_); }

 private:
  /// Whether `one` holds and the other children of `q` are denied.
  std::optional<bool> only(const Query& q, const Query& one, std::vector<Index>& slots,
                           const RuntimeKnowledge& k) const;
  bool holds_of_value(const Query& q, const std::vector<Index>& slots,
                      const RuntimeKnowledge& k) const;
  Extent extent_of_children(const Query& q, Subject of, std::vector<Index>& slots,
                            const RuntimeKnowledge& k) const;
  bool derived(const Query& q, const std::vector<Index>& slots) const;
  /// Evaluates with what is worked out of derived predicates on the way.
  template <class Evaluate>
  std::optional<bool> with_derived(const RuntimeKnowledge& k, Evaluate&& evaluate) const;
  ExternalResult call(const Query& q, const std::vector<Index>& slots, const RuntimeKnowledge& k,
                      std::vector<Index>* arguments = nullptr) const;
  [[nodiscard]] unsigned choice_of(Index external, const std::vector<Index>& arguments) const;
  ExternalResult ask(Index external, const std::vector<Index>& arguments,
                     const RuntimeKnowledge& k) const;

  const Model& model_;
  std::uint64_t seed_;
  unsigned attempts_;
  Choices choices_;
  mutable HandleTable handles_;
  /// Of functions that do not read the state.
  mutable std::map<std::pair<Index, std::vector<Index>>, ExternalResult> calls_;
  mutable DerivedFacts* derived_ = nullptr;  ///< while a query is evaluated
  mutable std::set<Fact>* noted_ = nullptr;
  mutable std::set<std::string> chosen_;  ///< calls that were made by a stated choice
};

}  // namespace kaboum::plan
