#pragma once

#include <kaboum/plan/known_facts.h>
#include <kaboum/plan/model.h>
#include <kaboum/plan/plan.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::plan {

/// Knowledge in a state of a run, by names.
class KnownState {
 public:
  virtual ~KnownState() = default;
  /// The known value of a function's term, an object's name or a handle's word; nullopt: not known,
  /// or the model has no such term.
  [[nodiscard]] virtual std::optional<std::string> value(
      const std::string& function, const std::vector<std::string>& arguments) const = 0;
  /// All that is known.
  [[nodiscard]] virtual KnownFacts facts() const = 0;
};

/// What an action has sensed of several values that were possible: "isSpillable(o1)", "true".
struct SensedValue {
  std::string fact, value;
};

/// A node of a plan as it is carried out in one state.
struct RunStep {
  Index node = 0;
  const KnownState& before;
  /// With what was sensed.
  const KnownState& after;
  Index next = kNone;         ///< a node; kNone: the end
  std::string outcome;        ///< "isSpillable(o1)", "!isSpillable(o1)"; empty: no branch
  std::uint64_t actions = 0;  ///< before this node on the way here
  std::vector<SensedValue> sensed = {};
  std::optional<SensedValue> decides = {};  ///< how it goes on; nullopt: no branch
  bool unplanned = false;                   ///< the branch has no case for that: `next` is kNone
};

/// Sensing has turned out as the plan has no branch for.
struct Unplanned {
  std::string outcome;        ///< "!isSpillable(o1)"
  KnownFacts known;           ///< then, with what was sensed
  std::uint64_t actions = 0;  ///< done so far
};

/// A fact that an action senses, and whose value a run has to be told.
struct SensedFact {
  Index node = 0;  ///< whose action it is
  const KnownState& before;
  std::string fact;                 ///< "isSpillable(o1)", "place(o2)"
  std::vector<std::string> values;  ///< that are possible: "true" and "false", or names
};

struct RunOptions {
  enum class Outcomes {
    All,     ///< every way that sensing may turn out
    Random,  ///< one run
    Given,   ///< one run; sensed values as `given` has them, at random where it has none
    Asked    ///< one run; sensed values as `sense` says
  };
  Outcomes outcomes = Outcomes::All;
  std::uint64_t seed = 1;
  /// By atom or term, "isSpillable(o1)": "true", "false", or the value's name.
  std::map<std::string, std::string> given = {};
  /// Says which of the values it is. Asked before the step of its node is told of, once for each
  /// fact that is not known then; a value that is none of them is an error.
  std::function<std::string(const SensedFact&)> sense = {};
  std::uint64_t most_states = 1'000'000;
  /// Called for what the plan has no branch for; the way through the plan ends there. None: that is
  /// an error.
  std::function<void(const Unplanned&)> unplanned = {};
};

struct RunSummary {
  /// Pairs of a node and a state of knowledge that were carried out. States that differ in no value
  /// of a term, and in no atom that is read from there on, are one, unless `unplanned` is called.
  std::uint64_t states = 0;
  std::uint64_t ends = 0;      ///< distinct of those at an end of the plan
  std::uint64_t branches = 0;  ///< ways through the plan, each outcome by itself; at most 10^18
};

/// Carries out a plan as far as what is known goes: calls `step` for every node in every state that
/// it is reached in (RunSummary::states), depth first. External functions are not called: what they
/// returned is what the plan says (`check` decides whether that is so, and whether preconditions
/// hold).
///
/// @throws Error{InvalidInput} for graphs with cycles, plans that do not say what their calls
///   returned, outcomes that no case of the plan is for (unless `unplanned` is told of them) or
///   that contradict what is known;
///   Error{LimitReached} beyond `most_states`; what `step` throws.
RunSummary run(const Model& model, const Plan& plan, const RunOptions& options,
               const std::function<void(const RunStep&)>& step);

}  // namespace kaboum::plan
