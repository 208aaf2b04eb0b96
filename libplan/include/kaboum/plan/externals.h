#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace kaboum::plan {

/// The state that an external function is asked about. What is read through it is noted: the
/// footprint of the call. In all states that agree on the footprint the answer is taken for the
/// same, so it may depend on nothing else.
class StateView {
 public:
  virtual ~StateView() = default;
  /// The value that a function term is known to have; nullopt: it is not known.
  /// @throws Error{InvalidInput} if the model has no such term.
  virtual std::optional<std::string> value(const std::string& function,
                                           const std::vector<std::string>& arguments) = 0;
  /// Decides whether an atom is known to be true or false; nullopt: neither.
  /// @throws Error{InvalidInput} if the model has no such atom.
  virtual std::optional<bool> truth(const std::string& predicate,
                                    const std::vector<std::string>& arguments) = 0;
  /// Whether the model has such a function term. It is the same in all states, and not noted.
  virtual bool has_term(const std::string& function, const std::vector<std::string>& arguments) = 0;
};

/// One call of an external function.
struct Question {
  std::span<const std::string> arguments;
  StateView& state;
  std::uint64_t seed = 0;  ///< of whatever is random: made of --seed, the function, the arguments
                           ///< and the attempt
  unsigned attempt = 0;    ///< 0, 1, ...: how often it was asked before; more samples are worth it
  /// 0, 1, ...: of several things that might do, to prefer another one each time.
  unsigned choice = 0;
  /// It is asked before the search: what takes long is to be left until all has been read that it
  /// may hang on (ExternalBinding::refuses_early).
  bool early = false;
};

struct Answer {
  enum class Kind : std::uint8_t {
    Value,      ///< of a truth value: true
    NotFound,   ///< nothing yet; a later attempt may find something
    Impossible  ///< there is no value; of a truth value: false
  };
  Kind kind = Kind::Impossible;
  std::string value;    ///< the name of an object of the function's type, or any word of a handle
  std::string payload;  ///< kept with the plan: a path, samples used, ...
  std::string reason;   ///< why there is no value: "blocked by o3"
  /// True of a value that was chosen among several, or without looking for others. Where a
  /// search with it fails, it is not proved that there is no plan.
  bool chosen = false;
  /// Among how many things `Question::choice` decides which one is preferred; 0: there is nothing
  /// to choose. Where the search fails by what rests on it, it begins anew with another choice. Not
  /// looked at where something is impossible: that is so whatever is chosen.
  unsigned choices = 0;
  /// True where it is impossible by what somebody has listed only, as grasps are: others might do.
  /// Where a search fails by that, there may be a plan all the same.
  bool listed = false;
  /// True of a value that is the only one, whatever the state; only the arguments decide it.
  bool fixed = false;

  static Answer found(std::string value, std::string payload = "") {
    return {Kind::Value, std::move(value), std::move(payload), ""};
  }
  static Answer holds(bool truth, std::string reason = "") {
    return {truth ? Kind::Value : Kind::Impossible, "", "", std::move(reason)};
  }
  static Answer not_found(std::string reason) {
    return {Kind::NotFound, "", "", std::move(reason)};
  }
  static Answer impossible(std::string reason) {
    return {Kind::Impossible, "", "", std::move(reason)};
  }
};

/// A host function: of names of its arguments alone (an empty string is "false" or "no value"), or
/// of a question.
class ExternalBinding {
 public:
  ExternalBinding() = default;
  template <class F>
  requires std::is_invocable_r_v<std::string, F&, std::span<const std::string>> ExternalBinding(
      F function)
      : answer_([f = std::move(function)](const Question& q) mutable {
          std::string value = f(q.arguments);
          return value.empty() ? Answer{} : Answer::found(std::move(value));
        }) {}
  /// @param reads_state  false: it asks for nothing of the state, so an answer is one for all.
  template <class F>
  requires std::is_invocable_r_v<Answer, F&, const Question&> ExternalBinding(
      F function, bool reads_state = true)
      : answer_(std::move(function)), reads_state_(reads_state), takes_seed_(true) {}

  [[nodiscard]] Answer operator()(const Question& question) const { return answer_(question); }
  [[nodiscard]] bool reads_state() const { return reads_state_; }
  /// True if what it answers may hang on the question's seed and attempt.
  [[nodiscard]] bool takes_seed() const { return takes_seed_; }
  /// True of a function that reads first what its arguments name, and says then where there is no
  /// value whatever else there is, before anything takes long. It may be asked before the search,
  /// and is stopped where it reads on.
  [[nodiscard]] bool refuses_early() const { return refuses_early_; }
  void refuse_early() { refuses_early_ = true; }

 private:
  std::function<Answer(const Question&)> answer_;
  bool reads_state_ = false;
  bool takes_seed_ = false;
  bool refuses_early_ = false;
};

/// Host functions by the name that `externals:` declares.
using ExternalBindings = std::map<std::string, ExternalBinding, std::less<>>;

}  // namespace kaboum::plan
